#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "frame/shadow_cube.glsl"
#include "frame/shadow_plane.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"

// For each light ray (θ_j, φ_k), the nearest occluder of the shadow map (section 4.1.3).
layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = k_shadow_map_unit) uniform sampler2DArray shadow_map;
layout(std430, binding = k_first_shadowed_storage) writeonly buffer FirstShadowed { uint first_shadowed[]; };

layout(constant_id = 3) const bool k_plane = false;  // the shadow map is on a plane

void main() {
  uint k = gl_GlobalInvocationID.x;
  uint j = gl_GlobalInvocationID.y;
  if (k >= k_phi_count || j >= k_theta_count) return;
  float phi = phi_of_cell(phi_cells(j), float(k) + 0.5);
  vec2 plane = plane_direction(j);
  vec3 outward = plane.x * space.u + plane.y * space.f;
  uint first = k_alpha_count;
  if (k_plane) {
    float across = crossing_of(space, phi);
    vec2 uv = plane_uv(light, across * outward);
    float depth = texelFetch(shadow_map, ivec3(cube_texel(uv, light.shadow_map_size), 0), 0).r;
    // Nothing that matters lies on light rays that pass the image by, nor on those that part from the eye.
    bool is_on_map = across >= 0.0 && max(abs(uv.x), abs(uv.y)) <= 1.0;
    // The map keeps view rays, and with them α.
    uint cell = first_shadowed_cell(space, angle_of(across, plane_z(light, depth)), k_alpha_count);
    if (is_on_map && depth != 0.0) first = cell;
  } else {
    float sin_phi = sine(phi);
    float cos_phi = cosine(phi);
    CubePoint point = cube_point(sin_phi * outward - cos_phi * space.axis);
    float depth = texelFetch(shadow_map, ivec3(cube_texel(point.uv, light.shadow_map_size), point.face), 0).r;
    float r = light.near / (max(depth, 1e-30) * point.depth);  // along the unit light ray
    uint cell = first_shadowed_cell(space, alpha_at(space, sin_phi, cos_phi, r), k_alpha_count);
    if (depth != 0.0) first = cell;
  }
  first_shadowed[j * k_phi_count + k] = first;
}
