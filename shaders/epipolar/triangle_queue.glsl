// How the triangles of a scene are shared out, some to one invocation, some to many. GLSL only; needs camera.glsl and
// conservative.glsl.
layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions

// Triangles that touch many planes, left by the first pass for the second: `many`, from the front, some hundreds of planes at
// most, `most`, from the back, more.
layout(std430, binding = k_queue_storage) buffer Queue {
  uvec3 many_groups;  // of an indirect dispatch: k_row × rows × 1 groups, one a triangle
  uint many_count;
  uvec3 most_groups;
  uint most_count;
  uint first_triangle;
  uint triangle_count;
  uint queue[];
};

const uint k_row = 256u;
const uint k_few = 64u;  // of several values tried on four scenes the fastest, by a factor of two over 4
const uint k_many = 512u;

// Queues a triangle that touches more than k_few planes. Returns how many the caller is to do itself.
uint own_planes(uint triangle, uint count) {
  if (count > k_many) {
    uint at = atomicAdd(most_count, 1u);
    queue[triangle_count - 1u - at] = triangle;
    atomicMax(most_groups.y, at / k_row + 1u);
  } else if (count > k_few) {
    uint at = atomicAdd(many_count, 1u);
    queue[at] = triangle;
    atomicMax(many_groups.y, at / k_row + 1u);
  }
  return count > k_few ? 0u : count;
}
