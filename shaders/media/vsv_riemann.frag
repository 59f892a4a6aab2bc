#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/vsv_ray.glsl"
#include "media/lamp.glsl"

// Airlight from the shadow volume as the paper sums it (Eq. 5), in φ instead of t: the integrand at the centre of every lit
// cell. A cell counts whole when its centre lies before the end of the ray. Deviation: with k_rough, where the integrand may change
// within a cell, its integral over what of the cell lies before that end, and the light's colour at the centre. In a layer that light
// or eye enters from above, a cell counts with what of it lies in the layer.
layout(constant_id = 9) const uint k_rough = 0;

void main() {
  VsvRay ray = vsv_ray(ivec2(gl_FragCoord.xy));
  LayerRay view = in_plane(ray.seen);
  vec3 sum = vec3(0.0);
  for (uint texel = 0u; texel < texel_count(ray); ++texel) {
    uvec4 lit = ~seen_bits(ray, texel) & before_end(ray, texel);
    while (lit != uvec4(0u)) {
      uint k = 128u * texel + take_lowest(lit);
      float phi = phi_of_cell(ray.cells, float(k) + 0.5);
      float from = phi_of_cell(ray.cells, float(k));
      float to = phi_of_cell(ray.cells, float(k + 1u));
      if (k_layer == k_layer_entered) {
        from = max(from, ray.seen.phi_start);
        to = min(to, ray.seen.phi_end);
        phi = 0.5 * (from + to);
        if (k_rough != 0u) {
          sum += integrate_lit(view, from, to, float(k_phi_count));
        } else if (from < to) {
          sum += (to - from) * integrand_at(view, phi) * colour_at(view, phi);
        }
      } else if (k_rough != 0u) {
        to = min(to, ray.seen.phi_end);
        sum += integrate_run(space, medium, k_phase, view.complement, from, to) * colour_at(view, phi);
      } else if (phi < ray.seen.phi_end) {
        sum += (to - from) * integrand_at(view, phi) * colour_at(view, phi);
      }
    }
  }
  // Before the half-plane's cells, and beyond them, all is lit.
  float first = min(phi_of_cell(ray.cells, 0.0), ray.seen.phi_end);
  float last = min(phi_of_cell(ray.cells, float(k_phi_count)), ray.seen.phi_end);
  float beyond = goes_beyond(ray) ? ray.seen.phi_end : last;
  sum += integrate_lit(view, ray.seen.phi_start, first, float(k_phi_count)) +
         integrate_lit(view, max(last, ray.seen.phi_start), beyond, float(k_phi_count));
  vec3 radiance = airlight_scale(space, light, medium, ray.seen.angle.sine) * sum;
  airlight = vec4(radiance, 1.0);
}
