#version 450

// Every invocation adds a uniform to its number's word, and 1 to the last word; the first says how many groups there are.
layout(local_size_x_id = 0, local_size_y = 2) in;
layout(constant_id = 7) const uint k_factor = 1;
layout(location = 3) uniform uint addend;
layout(std430, binding = 0) buffer Counts {
  uvec4 groups;
  uint invocations;
  uint sums;
};

void main() {
  if (gl_GlobalInvocationID == uvec3(0u)) groups = uvec4(gl_NumWorkGroups, 0u);
  atomicAdd(invocations, 1u);
  atomicAdd(sums, addend * k_factor);
}
