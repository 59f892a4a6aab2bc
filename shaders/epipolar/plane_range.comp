#version 450
#extension GL_GOOGLE_include_directive : require
#define PHI_RANGE_ACCESS
#include "epipolar/uniforms.glsl"
#include "epipolar/phi_range.glsl"

// The range of φ of each half-plane: where the scene's box reaches, as far as a view ray does.
layout(local_size_x = 64) in;
layout(binding = k_scratch_unit) uniform samplerBuffer box_ranges;  // vec2 a plane
layout(std430, binding = k_planes_storage) writeonly buffer Planes { vec4 plane_table[]; };

void main() {
  uint j = gl_GlobalInvocationID.x;
  if (j >= k_theta_count) return;
  vec2 range = texelFetch(box_ranges, int(j)).xy;
  range.y = min(range.y, phi_from_order(space, uintBitsToFloat(seen[j])));
  plane_table[2u * j + 1u] = vec4(range, 0.0, 0.0);
  atomicMax(phi_max, floatBitsToUint(max(range.y, 0.0)));
}
