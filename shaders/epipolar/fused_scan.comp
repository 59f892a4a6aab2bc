#version 450
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/window.glsl"

// Scatter and scan in one: a light ray is one number, its first cell of α in shadow, and the scanned bit at α_i is the
// comparison "first ≤ i". So each texel is written once, none is read back, and no invocation waits for another.
//
// The 128 comparisons of a texel are done at once, bit-sliced: bit k of slice b is bit b of the number of light ray k. Going
// over i from its high digits to its low ones, `below` collects the rays whose number is smaller already, `equal` those
// that agree so far. Of fused scans the grid must be clear: texels before the first shadow are not written.
layout(local_size_x = 4, local_size_y = 4) in;
layout(binding = k_first_shadowed_unit) uniform usamplerBuffer first_shadowed;  // four light rays a texel
layout(std430, binding = k_grid_storage) writeonly buffer Grid { uvec4 grid[]; };
layout(std430, binding = k_blocks_storage) writeonly buffer Blocks { uint blocks[]; };

layout(constant_id = 3) const uint k_digits = 10;  // of the numbers 0 … N_α
layout(constant_id = 4) const uint k_blocks = 0;   // whether to leave out texels that are like their neighbours (fused_scan.h)

// Written out instead of looped over, so that every index of `slice` is constant and it stays in registers: llvmpipe's loops
// over it took half as long again.
#define FOR_HIGH_DIGITS(DO)                                                                                          \
  DO(20u) DO(19u) DO(18u) DO(17u) DO(16u) DO(15u) DO(14u) DO(13u) DO(12u) DO(11u) DO(10u) DO(9u) DO(8u) DO(7u) DO(6u) \
  DO(5u) DO(4u) DO(3u)
#define FOR_DIGITS(DO) FOR_HIGH_DIGITS(DO) DO(2u) DO(1u) DO(0u)
#define ADD_RAYS(b) \
  if (b < k_digits) slice[b] |= (first >> b & 1u) << bit;
#define COMPARE(b)                         \
  if (b < k_digits) {                      \
    uint digit = 0u - (i >> b & 1u);       \
    below |= equal & ~slice[b] & digit;    \
    equal &= ~(slice[b] ^ digit);          \
  }
// Bit `bit` of all four components at once: rays bit, 32 + bit, 64 + bit and 96 + bit.
#define ADD_RAYS_OF(component)                                                    \
  {                                                                               \
    uvec4 first = uvec4(a.component, b.component, c.component, d.component);      \
    start = min(start, min(min(first.x, first.y), min(first.z, first.w)));        \
    end = max(end, max(max(first.x, first.y), max(first.z, first.w)));            \
    FOR_DIGITS(ADD_RAYS)                                                          \
    ++bit;                                                                        \
  }

void main() {
  uint texel = gl_GlobalInvocationID.x;
  uint plane = gl_GlobalInvocationID.y;
  if (texel >= k_texels_per_ray || plane >= window_planes) return;

  uvec4 slice[21];
  for (uint i = 0u; i < 21u; ++i) slice[i] = uvec4(0u);
  uint start = k_alpha_count;  // before it all of the rays are lit, …
  uint end = 0u;               // … and from here on none is
  int rays = int(((window_first_plane + plane) * k_texels_per_ray + texel) * 32u);
  uint bit = 0u;
  while (bit < 32u) {
    int at = rays + int(bit >> 2);
    uvec4 a = texelFetch(first_shadowed, at);
    uvec4 b = texelFetch(first_shadowed, at + 8);
    uvec4 c = texelFetch(first_shadowed, at + 16);
    uvec4 d = texelFetch(first_shadowed, at + 24);
    ADD_RAYS_OF(x)
    ADD_RAYS_OF(y)
    ADD_RAYS_OF(z)
    ADD_RAYS_OF(w)
  }

  // The texels that are stored, eight α at a time: all from the first shadow on, or from the last that is wholly lit to the first
  // that is wholly dark.
  uint first_row = start & ~7u;
  uint last_row = k_alpha_count - 1u;
  if (k_blocks != 0u) {
    first_row = max(start, 1u) - 1u;
    last_row = min(end, last_row);
    blocks[(window_first_plane + plane) * k_texels_per_ray + texel] = first_row | last_row << 16;
  }
  uint at = (plane * k_alpha_count + (first_row & ~7u)) * k_texels_per_ray + texel;
  for (uint i = first_row & ~7u; i <= last_row; i += 8u) {
    uvec4 below = uvec4(0u);
    uvec4 equal = uvec4(0xffffffffu);
    FOR_HIGH_DIGITS(COMPARE)
    // first's low digits ≤ 0, 1, … 7
    uvec4 zero2 = equal & ~slice[2];
    uvec4 zero1 = ~slice[1];
    uvec4 zero0 = ~slice[0];
    uvec4 texels[8] = uvec4[8](below | (zero2 & zero1 & zero0), below | (zero2 & zero1), below | (zero2 & (zero1 | zero0)),
                               below | zero2, below | zero2 | (equal & zero1 & zero0), below | zero2 | (equal & zero1),
                               below | zero2 | (equal & (zero1 | zero0)), below | equal);
    for (uint low = 0u; low < 8u; ++low) {
      if (i + low - first_row <= last_row - first_row) grid[at] = texels[low];
      at += k_texels_per_ray;
    }
  }
}
