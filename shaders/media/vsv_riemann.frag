#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/light_colour.glsl"
#include "media/vsv_ray.glsl"
#include "media/reach.glsl"

// Airlight from the shadow volume as the paper sums it (Eq. 5), in φ instead of t: the integrand at the centre of every lit
// cell. A cell counts whole when its centre lies before the end of the ray. Deviation: with k_rough, where the integrand may change
// within a cell, its integral over what of the cell lies before that end, and the light's colour at the centre. In a layer that light
// or eye enters from above, a cell counts with what of it lies in the layer.
layout(constant_id = 12) const uint k_reach = 0;  // reach.glsl
layout(constant_id = 13) const uint k_light_textured = 0;
layout(constant_id = 9) const uint k_rough = 0;
layout(binding = k_light_texture_unit) uniform sampler2D light_texture;

// Steps that half a turn has at most for what a light sends in different directions.
const float k_most_texture_steps = 1024.0;

// What the light sends along the light ray at φ to the view ray, relative to its intensity.
vec3 colour_at(LayerRay ray, float phi) {
  float share = reach_share(space, light, k_reach, ray, phi);
  if (k_light_textured == 0u) return vec3(share);
  return share * light_colour(light_texture, sine(phi) * ray.outward - cosine(phi) * space.axis);
}

// A lit part of the ray, in steps that follow the integrand, and where the light is not alike in all directions, or ends, no longer than equal
// cells would be, nor than half a texel of latitude; the light's colour in their middle.
vec3 integrate_lit(LayerRay ray, float from, float to) {
  vec3 sum = vec3(0.0);
  int most = k_layer == k_layer_entered ? k_most_layer_steps : k_most_steps;
  float longest = k_pi;
  if (k_light_textured != 0u || k_reach != 0u) {
    float rows = k_light_textured == 0u ? 0.0 : float(textureSize(light_texture, 0).y);
    longest = k_pi / min(max(2.0 * rows, float(k_phi_count)), k_most_texture_steps);
    most += int(k_most_texture_steps);
  }
  for (int i = 0; i < most && from < to; ++i) {
    float next;
    vec3 part;
    if (k_layer == k_layer_entered) {
      next = min(to, from + min(longest, smooth_layer_length(space, light, medium, k_phase, ray, from)));
      part = integrate_layer_cell(space, light, medium, k_phase, ray, from, next);
    } else {
      next = min(to, from + min(longest, smooth_length(space, medium, k_phase, ray.complement, from)));
      part = integrate_cell(space, medium, k_phase, ray.complement, from, next);
    }
    sum += part * colour_at(ray, 0.5 * (from + next));
    from = next;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  VsvRay ray = vsv_ray(pixel);
  LayerRay view = in_plane(ray);
  vec3 sum = vec3(0.0);
  for (uint texel = 0u; texel < texel_count(ray); ++texel) {
    uvec4 lit = ~seen_bits(ray, texel) & before_end(ray, texel);
    while (lit != uvec4(0u)) {
      uint k = 128u * texel + take_lowest(lit);
      float phi = phi_of_cell(ray.cells, float(k) + 0.5);
      float from = phi_of_cell(ray.cells, float(k));
      float to = phi_of_cell(ray.cells, float(k + 1u));
      if (k_layer == k_layer_entered) {
        from = max(from, ray.phi_start);
        to = min(to, ray.phi_end);
        phi = 0.5 * (from + to);
        if (k_rough != 0u) {
          sum += integrate_lit(view, from, to);
        } else if (from < to) {
          sum += (to - from) * layer_integrand(space, light, medium, k_phase, view, phi) * colour_at(view, phi);
        }
      } else if (k_rough != 0u) {
        to = min(to, ray.phi_end);
        sum += integrate_run(space, medium, k_phase, view.complement, from, to) * colour_at(view, phi);
      } else if (phi < ray.phi_end) {
        sum += (to - from) * airlight_integrand(space, medium, k_phase, view.complement, phi) * colour_at(view, phi);
      }
    }
  }
  // Before the half-plane's cells, and beyond them, all is lit.
  float first = min(phi_of_cell(ray.cells, 0.0), ray.phi_end);
  float last = min(phi_of_cell(ray.cells, float(k_phi_count)), ray.phi_end);
  sum += integrate_lit(view, ray.phi_start, first) + integrate_lit(view, max(last, ray.phi_start), goes_beyond(ray) ? ray.phi_end : last);
  vec3 radiance = airlight_scale(space, light, medium, ray.angle.sine) * sum;
  airlight = vec4(radiance, 1.0);
}
