// The passes over a scene's triangles, a program each of one entry point: over all triangles, one an invocation, where those
// that meet few planes are voxelized and the others queued; and over either end of the queue, where gl_NumWorkGroups.z groups a
// triangle share its planes. GLSL only; after triangle_queue.glsl and what defines TRIANGLE, fetch_triangle and
// voxelize_in_plane.
layout(local_size_x = 64) in;
layout(constant_id = 3) const uint k_pass = 0;
const uint k_pass_over_all = 0u;
const uint k_pass_over_many = 1u;  // else over most

void main() {
  if (k_pass == k_pass_over_all) {
    if (gl_GlobalInvocationID.x >= triangle_count) return;
    uint index = first_triangle + gl_GlobalInvocationID.x;
    TRIANGLE triangle = fetch_triangle(index);
    uint end = own_planes(index, plane_count(triangle.planes));
    for (uint plane = 0u; plane < end; ++plane) voxelize_in_plane(triangle, plane);
  } else {
    uint at = gl_WorkGroupID.y * k_row + gl_WorkGroupID.x;
    if (at >= (k_pass == k_pass_over_many ? many_count : most_count)) return;
    TRIANGLE triangle = fetch_triangle(queue[k_pass == k_pass_over_many ? at : triangle_count - 1u - at]);
    uint count = plane_count(triangle.planes);
    uint stride = 64u * gl_NumWorkGroups.z;
    for (uint plane = gl_WorkGroupID.z * 64u + gl_LocalInvocationID.x; plane < count; plane += stride) {
      voxelize_in_plane(triangle, plane);
    }
  }
}
