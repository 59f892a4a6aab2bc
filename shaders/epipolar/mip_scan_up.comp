#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/mip_scan.glsl"

// A level of the chain from the one below it: the OR of each pair of neighbours in α.
void main() {
  uint plane = gl_GlobalInvocationID.y;
  uint i = gl_GlobalInvocationID.x / k_texels_per_ray;
  uint texel = gl_GlobalInvocationID.x % k_texels_per_ray;
  if (i >= coarse_size || plane >= window_planes) return;
  uvec4 bits = fine_texel(plane, 2u * i, texel);
  if (2u * i + 1u < fine_size) bits |= fine_texel(plane, 2u * i + 1u, texel);
  chain[chain_index(plane, coarse_start + i, texel)] = bits;
}
