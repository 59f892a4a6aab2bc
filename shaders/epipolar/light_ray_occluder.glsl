// The nearest occluder on a light ray, from the shadow map. GLSL only; needs view.glsl, shadow_cube.glsl, grid.glsl and
// resolution.glsl.
layout(std140, binding = 0) uniform ViewUniform { ViewBlock view; };
layout(std140, binding = 1) uniform EpipolarUniform { EpipolarBlock space; };
layout(binding = 0) uniform sampler2DArray shadow_map;

// The first cell in α that lies in shadow on the light ray at φ, N_α if none does. `outward` is the unit vector in the ray's
// epipolar half-plane at right angles to the axis.
uint first_shadowed_on(vec3 outward, float phi) {
  float sin_phi = sin(phi);
  float cos_phi = cos(phi);
  CubePoint point = cube_point(sin_phi * outward - cos_phi * space.axis);
  float depth = texelFetch(shadow_map, ivec3(cube_texel(point.uv, view.shadow_map_size), point.face), 0).r;
  if (depth == 0.0) return k_alpha_count;
  float r = view.light_near / (depth * point.depth);  // along the unit light ray
  return first_shadowed_cell(space, alpha_at(space, sin_phi, cos_phi, r), k_alpha_count);
}
