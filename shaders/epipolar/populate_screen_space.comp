#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/populate_screen_space.glsl"

// One invocation a triangle; those that meet many planes wait for the second pass.
layout(local_size_x = 64) in;

void main() {
  if (gl_GlobalInvocationID.x >= triangle_count) return;
  uint triangle = first_triangle + gl_GlobalInvocationID.x;
  ScreenTriangle t = fetch_triangle(triangle);
  uint end = own_planes(triangle, plane_count(t.planes));
  for (uint index = 0u; index < end; ++index) flip_in_plane(t, index);
}
