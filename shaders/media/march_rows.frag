#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/vsv_ray.glsl"
#include "media/march.glsl"

// By look-ups of a half-plane's row of light rays, to which the shadow map is resampled: neighbours on a view ray are neighbours in
// memory. What the row cannot tell of this ray is known as of a volume's.
VsvRay row;

vec3 light_along(MediumRay ray, float t, float phi) {
  float cell = floor(cell_of_phi(row.cells, phi));
  bool is_in_row = cell >= 0.0 && cell < float(k_phi_count);
  uint k = uint(clamp(cell, 0.0, float(k_phi_count) - 1.0));
  bool is_shadowed = int(k) > row.last_valid ? row.beyond_valid != 0u : is_dark(row.plane, row.row, k);
  return vec3(!is_in_row || !is_shadowed ? 1.0 : 0.0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  row = vsv_ray(texel);
  airlight = march_airlight(row.seen, ivec2(ray_place(texel)));
}
