#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/vsv_ray.glsl"
#include "media/vsv_table.glsl"

// Airlight from the shadow volume, exact up to the visibility bits: between two changes of visibility the integral is a
// difference of two entries of the table, so a pixel costs as many look-ups as it sees changes, not samples.
//
// With k_factored, the factored visibility of Dobashi et al. 2002: the integral as if all of the ray were lit, times the lit
// fraction of its samples. That takes one look-up a pixel, and does not ask where on the ray the shadow lies. The samples of the
// paper are equal steps of φ; so that the result does not depend on how cells grow, the bits of a word weigh what it spans.
layout(binding = k_table_unit) uniform samplerBuffer table;  // vec4

// A ray that ends within this many cells is integrated directly: where α → π the integral and sin α vanish together, and
// an interpolated table keeps no digits of their ratio. 0 for a view that does not reach there (media/vsv.cpp): llvmpipe
// runs both sides of a branch.
layout(constant_id = 6) const uint k_direct_cells = 0;
layout(constant_id = 7) const uint k_factored = 0;

// Adds sign · T at a place in the frame's range of φ, by the two rows.
void add_entry(float place, uint row_start, float sign, inout vec2 sum[3]) {
  float at = clamp(place * float(k_phi_count), 0.0, float(k_phi_count));
  float column = min(floor(at), float(k_phi_count) - 1.0);
  float blend = at - column;
  for (uint channel = 0u; channel < k_channels; ++channel) {
    vec4 entry = texelFetch(table, int(row_start + uint(column) * k_channels + channel));
    sum[channel] += sign * mix(entry.xy, entry.zw, blend);
  }
}

void main() {
  VsvRay ray = vsv_ray(ivec2(gl_FragCoord.xy));

  vec3 integral = vec3(0.0);
  if (ray.last_cell < k_direct_cells) {
    float complement = alpha_complement(ray.seen.angle);
    uint shadow = 0u;
    Changes changes = changes_along(ray);
    while (has_changes(ray, changes)) {
      uint cell = next_change(ray, changes);
      if (cell <= ray.last_cell) shadow ^= 0xffffffffu << cell;
    }
    float first = min(phi_of_cell(ray.cells, 0.0), ray.seen.phi_end);
    integral += integrate_run(space, medium, k_phase, complement, 0.0, first);
    for (uint k = 0u; k <= ray.last_cell; ++k) {
      if ((shadow >> k & 1u) != 0u) continue;
      float from = phi_of_cell(ray.cells, float(k));
      float to = min(phi_of_cell(ray.cells, float(k + 1u)), ray.seen.phi_end);
      integral += integrate_run(space, medium, k_phase, complement, from, to);
    }
  } else {
    vec2 range = table_range(space);
    float row = (table_place(ray.seen.alpha) - range.x) / (range.y - range.x) * (float(k_table_rows) - 1.0);
    row = clamp(row, 0.0, float(k_table_rows) - 1.001);
    uint row_start = table_index(uint(row), 0u, 0u);
    float blend = row - floor(row);
    vec2 sum[3] = vec2[3](vec2(0.0), vec2(0.0), vec2(0.0));
    for (uint channel = 0u; channel < k_channels; ++channel) sum[channel] = texelFetch(table, int(row_start + channel)).xy;
    float sign = -1.0;  // − where light ends, + where it begins
    float word_start = phi_of_cell(ray.cells, 0.0);
    float lit_range = min(word_start, ray.seen.phi_end);  // of φ
    float dark_range = 0.0;
    if (k_factored != 0u) {
      for (uint texel = 0u; texel < texel_count(ray); ++texel) {
        uvec4 shadow = seen_bits(ray, texel);
        uvec4 inside = before_end(ray, texel);
        for (uint word = 0u; word < 4u; ++word) {
          float word_end = phi_of_cell(ray.cells, float(128u * texel + 32u * word + 32u));
          float width = (word_end - word_start) / 32.0;
          dark_range += width * float(bitCount(shadow[word] & inside[word]));
          lit_range += width * float(bitCount(~shadow[word] & inside[word]));
          word_start = word_end;
        }
      }
    } else {
      Changes changes = changes_along(ray);
      while (has_changes(ray, changes)) {
        uint cell = next_change(ray, changes);
        if (cell < k_phi_count) {
          add_entry(place_of_cell(ray.cells, float(cell)), row_start, sign, sum);
          sign = -sign;
        }
      }
    }
    // Where the half-plane's cells end before the ray, all beyond is lit.
    if (sign > 0.0 && goes_beyond(ray)) {
      add_entry(place_of_cell(ray.cells, float(k_phi_count)), row_start, sign, sum);
      sign = -sign;
    }
    // The ray ends in light: close the last lit run. (Factored, it is the only one.)
    bool ends_in_light = sign < 0.0;
    if (ends_in_light && ray.seen.is_open) {
      uint beyond = row_start + (k_phi_count + 1u) * k_channels;
      for (uint channel = 0u; channel < k_channels; ++channel) sum[channel] += texelFetch(table, int(beyond + channel)).xy;
    } else if (ends_in_light) {
      add_entry(k_rough != 0u ? place_of_cell(ray.cells, float(ray.last_cell)) : place_of_phi(ray.cells, ray.seen.phi_end), row_start,
                sign, sum);
    }
    for (uint channel = 0u; channel < 3u; ++channel) {
      vec2 rows = sum[min(channel, k_channels - 1u)];
      integral[channel] = mix(rows.x, rows.y, blend);
    }
    // What the table leaves to the end: within a cell, or beyond its last column.
    if (k_rough != 0u || k_layer != k_no_layer) {
      float from = k_rough != 0u ? phi_of_cell(ray.cells, float(ray.last_cell)) : ray.cells.phi_max;
      if (ends_in_light && !ray.seen.is_open)
        integral += integrate_run(space, medium, k_phase, alpha_complement(ray.seen.angle), from, ray.seen.phi_end);
    }
    if (k_factored != 0u) {
      if (goes_beyond(ray)) lit_range += ray.seen.phi_end - word_start;
      integral *= lit_range / (lit_range + dark_range);
    }
  }
  vec3 radiance = airlight_scale(space, light, medium, ray.seen.angle.sine) * max(integral, vec3(0.0));
  airlight = vec4(radiance, 1.0);
}
