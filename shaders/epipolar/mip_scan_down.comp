#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/mip_scan.glsl"

// The scan of a level from the scan of the coarser one: an entry at the end of a pair has its pair's sum, one at the
// beginning adds itself to the sum of the pairs before it. In place: an entry is read only by who writes it.
void main() {
  uint plane = gl_GlobalInvocationID.y;
  uint i = gl_GlobalInvocationID.x / k_texels_per_ray;
  uint texel = gl_GlobalInvocationID.x % k_texels_per_ray;
  if (i >= fine_size || plane >= window_planes) return;
  uvec4 sum = uvec4(0u);
  if ((i & 1u) == 0u) sum = fine_texel(plane, i, texel);
  if (i > 0u) sum |= coarse_texel(plane, (i - 1u) >> 1, texel);
  if (k_fine_is_grid != 0u) {
    grid[(plane * k_alpha_count + i) * k_texels_per_ray + texel] = sum;
  } else {
    chain[chain_index(plane, fine_start + i, texel)] = sum;
  }
}
