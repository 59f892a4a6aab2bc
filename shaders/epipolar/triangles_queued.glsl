// The second pass, over the queued triangles: gl_NumWorkGroups.z groups a triangle share its planes. GLSL only; after a file
// that defines TRIANGLE, fetch_triangle and voxelize_in_plane.
layout(local_size_x = 64) in;
layout(constant_id = 3) const uint k_from_back = 0;

void main() {
  uint at = gl_WorkGroupID.y * k_row + gl_WorkGroupID.x;
  if (at >= (k_from_back != 0u ? most_count : many_count)) return;
  TRIANGLE triangle = fetch_triangle(queue[k_from_back != 0u ? triangle_count - 1u - at : at]);
  uint count = plane_count(triangle.planes);
  uint stride = 64u * gl_NumWorkGroups.z;
  for (uint plane = gl_WorkGroupID.z * 64u + gl_LocalInvocationID.x; plane < count; plane += stride) {
    voxelize_in_plane(triangle, plane);
  }
}
