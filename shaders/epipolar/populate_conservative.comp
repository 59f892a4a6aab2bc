#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/populate_conservative.glsl"

// One invocation a triangle: those that touch few slabs are voxelized here, the others wait for the second pass, which gives
// each a group or more.
layout(local_size_x = 64) in;

const uint k_few = 64u;
const uint k_many = 512u;

void main() {
  uint triangle = gl_GlobalInvocationID.x;
  if (triangle >= triangle_count) return;
  VoxelTriangle voxels = fetch_triangle(triangle);
  uint slabs = voxels.slabs.count + voxels.slabs.wrapped_count;
  if (slabs > k_many) {
    uint at = atomicAdd(most_count, 1u);
    queue[triangle_count - 1u - at] = triangle;
    atomicMax(most_groups.y, at / k_row + 1u);
  } else if (slabs > k_few) {
    uint at = atomicAdd(many_count, 1u);
    queue[at] = triangle;
    atomicMax(many_groups.y, at / k_row + 1u);
  }
  uint end = slabs > k_few ? 0u : slabs;
  for (uint index = 0u; index < end; ++index) voxelize_in_slab(voxels, index);
}
