#version 450

// One of every kind of resource, for spirv_test.cpp.
layout(local_size_x_id = 4) in;
layout(constant_id = 2) const uint k_first = 1;
layout(constant_id = 9) const uint k_unused = 1;
layout(std140, binding = 3) uniform Block { uint offset; };
layout(binding = 5) uniform usamplerBuffer texels;
layout(binding = 6) uniform sampler2D pictures[4];
layout(binding = 1, r32f) uniform readonly image2D image_read;
layout(binding = 2, r32f) uniform writeonly image3D image_written;
layout(std430, binding = 4) readonly buffer Read { uint count; uint read[]; };
layout(std430, binding = 6) buffer Written { readonly uint size; uint written[]; };
layout(location = 0) uniform uint plain;

void main() {
  uint i = gl_GlobalInvocationID.x + k_first + plain;
  if (k_first == 7u || i + plain == 9u) return;
  written[i] = read[i] + offset + texelFetch(texels, int(i)).r;
  imageStore(image_written, ivec3(i), imageLoad(image_read, ivec2(i)) + texelFetch(pictures[i & 3u], ivec2(0), 0));
}
