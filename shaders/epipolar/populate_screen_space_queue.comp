#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/populate_screen_space.glsl"

// The queued triangles: gl_NumWorkGroups.z groups a triangle share its planes.
layout(local_size_x = 64) in;
layout(constant_id = 3) const uint k_from_back = 0;

void main() {
  uint at = gl_WorkGroupID.y * k_row + gl_WorkGroupID.x;
  if (at >= (k_from_back != 0u ? most_count : many_count)) return;
  ScreenTriangle t = fetch_triangle(queue[k_from_back != 0u ? triangle_count - 1u - at : at]);
  uint count = plane_count(t.planes);
  uint stride = 64u * gl_NumWorkGroups.z;
  for (uint index = gl_WorkGroupID.z * 64u + gl_LocalInvocationID.x; index < count; index += stride) {
    flip_in_plane(t, index);
  }
}
