// The first pass over a queue's triangles, one an invocation: those that meet few planes are voxelized here, the others wait for
// the second pass. GLSL only; after a file that defines TRIANGLE, fetch_triangle and voxelize_in_plane.
layout(local_size_x = 64) in;

void main() {
  if (gl_GlobalInvocationID.x >= triangle_count) return;
  uint index = first_triangle + gl_GlobalInvocationID.x;
  TRIANGLE triangle = fetch_triangle(index);
  uint end = own_planes(index, plane_count(triangle.planes));
  for (uint plane = 0u; plane < end; ++plane) voxelize_in_plane(triangle, plane);
}
