#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "frame/shadow_cube.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "epipolar/planes.glsl"

// For each light ray (θ_j, φ_k), the nearest occluder of the shadow map (section 4.1.3).
layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = k_shadow_map_unit) uniform sampler2DArray shadow_map;
layout(std430, binding = k_first_shadowed_storage) writeonly buffer FirstShadowed { uint first_shadowed[]; };

const uint k_planes = 16u;  // an invocation's: what depends on φ alone is worked out once

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= k_phi_count) return;
  float phi = phi_of_cell(phi_cells(), float(k) + 0.5);
  float sin_phi = sine(phi);
  float cos_phi = cosine(phi);
  uint end = min((gl_GlobalInvocationID.y + 1u) * k_planes, k_theta_count);
  for (uint j = gl_GlobalInvocationID.y * k_planes; j < end; ++j) {
    vec2 plane = texelFetch(planes, int(j)).xy;
    vec3 outward = plane.x * space.u + plane.y * space.f;
    CubePoint point = cube_point(sin_phi * outward - cos_phi * space.axis);
    float depth = texelFetch(shadow_map, ivec3(cube_texel(point.uv, light.shadow_map_size), point.face), 0).r;
    float r = light.near / (max(depth, 1e-30) * point.depth);  // along the unit light ray
    uint first = first_shadowed_cell(space, alpha_at(space, sin_phi, cos_phi, r), k_alpha_count);
    first_shadowed[j * k_phi_count + k] = depth == 0.0 ? k_alpha_count : first;
  }
}
