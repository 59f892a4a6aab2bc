#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/vsv_ray.glsl"
#include "media/sun.glsl"

// Airlight of a sun from the shadow volume, exact up to the visibility bits: each lit run between two changes of visibility in
// closed form. With k_factored, that of the whole ray times the lit fraction of its samples (media/vsv_table.frag); with k_riemann,
// the paper's sum over the centres of lit cells (media/vsv_riemann.frag). Deviation: a cell counts with what of it lies in the ray's
// part in the medium.
layout(constant_id = 6) const uint k_sum = 0;  // media/vsv.cpp
const uint k_runs = 0u;
const uint k_riemann = 1u;
const uint k_factored = 2u;

void main() {
  VsvRay ray = vsv_ray(ivec2(gl_FragCoord.xy));
  SunRay sun = sun_ray(medium, light, ray.seen.direction, ray.seen.distance);
  // From s to the distance along the ray, within the medium.
  float stretch = 1.0 / ray.seen.angle.sine;
  float grid_start = clamp(phi_of_cell(ray.cells, 0.0) * stretch, sun.entry, sun.exit);  // before it and …
  float grid_end = clamp(phi_of_cell(ray.cells, float(k_phi_count)) * stretch, sun.entry, sun.exit);  // … beyond, all is lit
  vec3 integral = vec3(0.0);
  float lit_range = min(grid_start, grid_end);  // of the ray before the grid's end [m]
  float dark_range = 0.0;
  float lit_from = sun.entry;
  bool is_lit = true;
  if (k_sum == k_runs) {
    Changes changes = changes_along(ray);
    while (has_changes(ray, changes)) {
      uint k = next_change(ray, changes);
      if (k < k_phi_count) {
        float at = clamp(phi_of_cell(ray.cells, float(k)) * stretch, sun.entry, sun.exit);
        if (is_lit) integral += integrate_sun_run(medium, sun, lit_from, at);
        is_lit = !is_lit;
        lit_from = at;
      }
    }
  } else {
    for (uint texel = 0u; texel < texel_count(ray); ++texel) {
      uvec4 shadow = seen_bits(ray, texel);
      uvec4 inside = before_end(ray, texel);
      if (k_sum == k_factored) {
        for (uint word = 0u; word < 4u; ++word) {
          float first = float(128u * texel + 32u * word);
          float width = stretch * (phi_of_cell(ray.cells, first + 32.0) - phi_of_cell(ray.cells, first)) / 32.0;
          dark_range += width * float(bitCount(shadow[word] & inside[word]));
          lit_range += width * float(bitCount(~shadow[word] & inside[word]));
        }
      } else {
        uvec4 lit = ~shadow & inside;
        while (lit != uvec4(0u)) {
          float k = float(128u * texel + take_lowest(lit));
          float from = clamp(phi_of_cell(ray.cells, k) * stretch, sun.entry, sun.exit);
          float to = clamp(phi_of_cell(ray.cells, k + 1.0) * stretch, sun.entry, sun.exit);
          float path = sun.path + sun.slope * (0.5 * (from + to) - sun.entry);
          integral += (to - from) * exp(-min(medium.sigma_t * path, vec3(k_deepest)));
        }
      }
    }
  }
  if (k_sum == k_runs) {
    if (is_lit) integral += integrate_sun_run(medium, sun, lit_from, sun.exit);
    else if (goes_beyond(ray)) integral += integrate_sun_run(medium, sun, grid_end, sun.exit);
  } else {
    if (k_sum == k_factored) {
      integral = integrate_sun_run(medium, sun, sun.entry, grid_end) * (lit_range / max(lit_range + dark_range, 1e-30));
    } else {
      integral += integrate_sun_run(medium, sun, sun.entry, grid_start);
    }
    if (goes_beyond(ray)) integral += integrate_sun_run(medium, sun, grid_end, sun.exit);
  }
  airlight = vec4(sun_scale(light, medium, k_phase, ray.seen.alpha) * integral, 1.0);
}
