#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/resolution.glsl"
#include "epipolar/window.glsl"

// Inside is where an odd number of crossings lies beyond: bit k is the XOR of the flips of bits k and higher. What is
// inside is added to the grid.
layout(local_size_x = 64) in;
layout(binding = k_grid_unit) uniform usamplerBuffer grid_texels;
layout(binding = k_scratch_unit) uniform usamplerBuffer flip_texels;
layout(std430, binding = k_grid_storage) writeonly buffer Grid { uvec4 grid[]; };

// Of each bit and all higher ones of the word; `beyond` is all ones where the words beyond hold an odd number, and becomes that
// for the next word.
uint odd_from(uint word, inout uint beyond) {
  word ^= word >> 1;
  word ^= word >> 2;
  word ^= word >> 4;
  word ^= word >> 8;
  word ^= word >> 16;
  word ^= beyond;
  beyond = 0u - (word & 1u);
  return word;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint plane = gl_GlobalInvocationID.y;
  if (i >= k_alpha_count || plane >= window_planes) return;
  uint row = (plane * k_alpha_count + i) * k_texels_per_ray;
  uint before = window_first_plane * k_alpha_count * k_texels_per_ray;
  uint beyond = 0u;
  for (uint back = 1u; back <= k_texels_per_ray; ++back) {
    uint at = row + k_texels_per_ray - back;
    uvec4 flips = texelFetch(flip_texels, int(at));
    uvec4 inside;
    inside.w = odd_from(flips.w, beyond);
    inside.z = odd_from(flips.z, beyond);
    inside.y = odd_from(flips.y, beyond);
    inside.x = odd_from(flips.x, beyond);
    grid[at] = texelFetch(grid_texels, int(before + at)) | inside;
  }
}
