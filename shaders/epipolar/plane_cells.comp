#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "epipolar/phi_range.glsl"

// How each half-plane cuts its range of φ: worked out once, for all who look up its cells.
layout(local_size_x = 64) in;
layout(std430, binding = k_planes_storage) writeonly buffer Planes { vec4 plane_table[]; };

void main() {
  uint j = gl_GlobalInvocationID.x;
  if (j >= k_theta_count) return;
  vec2 range = plane_phi(j);
  PhiCells cells = space.own_ranges == 0.0
                       ? shared_cells(largest_phi(), phi_growth, float(k_phi_count))
                       : own_cells(largest_phi(), phi_growth, float(k_phi_count), range.x, range.y);
  plane_table[2u * j + 1u] = vec4(range, cells.first, cells.per_cell);
}
