#version 450

// Writes to every texel of a level where it is.
layout(local_size_x = 4, local_size_y = 4) in;
layout(binding = 0, rgba16f) uniform writeonly image3D level;
layout(binding = 1, r32f) uniform writeonly image2DArray layers;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (all(lessThan(at, imageSize(level)))) imageStore(level, at, vec4(at, 1.0));
  if (all(lessThan(at, imageSize(layers)))) imageStore(layers, at, vec4(at.x + 10 * at.y + 100 * at.z));
}
