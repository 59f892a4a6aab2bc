// The scanned grid as it is read. GLSL only.
#include "bindings.glsl"
#include "epipolar/resolution.glsl"

layout(binding = k_grid_unit) uniform usamplerBuffer grid_texels;  // or what is asked in its place (media/vsv_ray.glsl)
layout(binding = k_blocks_unit) uniform usamplerBuffer blocks;

// Whether texels are stored by blocks (epipolar/fused_scan.h).
layout(constant_id = 23) const uint k_blocks = 0;

// 128 bits of a view ray. What lies before its block's first row that is stored is like that row, as is what lies beyond the last one.
// Two fetches and no branch: llvmpipe runs both sides of one.
uvec4 grid_bits(uint plane, uint row, uint texel) {
  if (k_blocks != 0u) {
    uint rows = texelFetch(blocks, int(plane * k_texels_per_ray + texel)).x;
    row = clamp(row, rows & 0xffffu, rows >> 16);
  }
  return texelFetch(grid_texels, int((plane * k_alpha_count + row) * k_texels_per_ray + texel));
}

// words[i], i ≤ 3.
uint component_of(uvec4 words, uint i) { return i == 0u ? words.x : i == 1u ? words.y : i == 2u ? words.z : words.w; }

bool is_bit_set(uint plane, uint row, uint cell) {
  uint bits = component_of(grid_bits(plane, row, cell >> 7), cell >> 5 & 3u);
  return (bits >> (cell & 31u) & 1u) != 0u;
}
