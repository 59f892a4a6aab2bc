#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/populate_conservative.glsl"

// One invocation a triangle: those that touch few planes are voxelized here, the others wait for the second pass, which gives
// each a group or more.
layout(local_size_x = 64) in;

void main() {
  if (gl_GlobalInvocationID.x >= triangle_count) return;
  uint triangle = first_triangle + gl_GlobalInvocationID.x;
  VoxelTriangle voxels = fetch_triangle(triangle);
  uint end = own_planes(triangle, plane_count(voxels.planes));
  for (uint index = 0u; index < end; ++index) voxelize_in_plane(voxels, index);
}
