#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/light_colour.glsl"
#include "media/vsv_ray.glsl"

// Airlight from the shadow volume as the paper sums it (Eq. 5), in φ instead of t: the integrand at the centre of every lit
// cell. A cell counts whole when its centre lies before the end of the ray. Deviation: with k_rough, where the integrand may change
// within a cell, its integral over what of the cell lies before that end, and the light's colour at the centre.
layout(constant_id = 4) const uint k_light_textured = 0;
layout(constant_id = 9) const uint k_rough = 0;
layout(binding = k_light_texture_unit) uniform sampler2D light_texture;

// What the light radiates along the light ray at φ, relative to its intensity. `outward` is the direction in the plane of the
// view ray at right angles to the axis.
vec3 colour_at(vec3 outward, float phi) {
  if (k_light_textured == 0u) return vec3(1.0);
  return light_colour(light_texture, sine(phi) * outward - cosine(phi) * space.axis);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  VsvRay ray = vsv_ray(pixel);
  float complement = alpha_complement(ray.angle);
  vec3 direction = view_ray(camera, vec2(pixel) + 0.5);
  vec3 outward = dot(direction, space.u) * space.u + dot(direction, space.f) * space.f;
  outward = unit_or(outward, space.u);
  vec3 sum = vec3(0.0);
  uvec4 words;
  uint before = ray.unknown;
  for (uint word = 0u; word <= ray.last_cell >> 5; ++word) {
    if ((word & 3u) == 0u) words = texelFetch(grid_texels, ray.texel + int(word >> 2));
    uint lit = ~seen_bits(ray, words.x, word, before);
    words.xyz = words.yzw;
    if (word == ray.last_cell >> 5) lit &= low_bits((ray.last_cell & 31u) + 1u);
    while (lit != 0u) {
      uint k = 32u * word + uint(findLSB(lit));
      lit &= lit - 1u;
      float phi = phi_of_cell(ray.cells, float(k) + 0.5);
      float from = phi_of_cell(ray.cells, float(k));
      float to = phi_of_cell(ray.cells, float(k + 1u));
      if (k_rough != 0u) {
        to = min(to, ray.phi_end);
        sum += integrate_run(space, medium, k_phase, complement, from, to) * colour_at(outward, phi);
      } else if (phi < ray.phi_end) {
        sum += (to - from) * airlight_integrand(space, medium, k_phase, complement, phi) * colour_at(outward, phi);
      }
    }
  }
  vec3 radiance = airlight_scale(space, light, medium, ray.angle.sine) * sum;
  airlight = vec4(radiance, 1.0);
}
