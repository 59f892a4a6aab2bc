// Whether the light reaches a point in the air, by the nearest texel of the shadow map. GLSL only; needs frame/uniforms.glsl.
// Based on: Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978. No bias: what is looked up lies before surfaces.
#include "frame/shadow_cube.glsl"
#include "frame/shadow_plane.glsl"

layout(binding = k_shadow_map_unit) uniform sampler2DArray shadow_map;
layout(constant_id = 16) const uint k_plane = 0;  // the shadow map is on a plane

bool is_lit_by_plane(vec3 point) {
  // Nothing that matters lies on light rays that pass the image by, nor on those that part from the eye.
  float share = plane_share(light, point);
  vec3 mapped = share > 0.0 ? point / share : vec3(0.0);
  vec2 uv = plane_uv(light, mapped);
  float depth = texelFetch(shadow_map, ivec3(cube_texel(uv, light.shadow_map_size), 0), 0).r;
  bool is_on_map = share > 0.0 && max(abs(uv.x), abs(uv.y)) <= 1.0;
  return !is_on_map || depth == 0.0 || plane_z(light, depth) <= dot(light.axis, mapped);
}

bool is_lit_by_cube(vec3 point) {
  CubePoint place = cube_point(point - light.from_eye);
  float depth = texelFetch(shadow_map, ivec3(cube_texel(place.uv, light.shadow_map_size), place.face), 0).r;
  return place.depth * depth <= light.near;
}

// `point`: relative to the eye.
bool is_lit(vec3 point) { return k_plane != 0u ? is_lit_by_plane(point) : is_lit_by_cube(point); }
