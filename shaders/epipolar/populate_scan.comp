#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/view.glsl"
#include "frame/shadow_cube.glsl"
#include "epipolar/grid.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "epipolar/light_ray_occluder.glsl"

// Populate and scan in one: the shadow map gives one number a light ray, the first cell of α in shadow, and the scanned
// word at α_i is the comparison "first ≤ i" for its 32 light rays. So each word is written once, nothing is cleared or read
// back, and no invocation waits for another.
//
// The 32 comparisons are done at once, bit-sliced: bit k of slice b is bit b of the number of light ray k. Going over i
// from its high digits to its low ones, `below` collects the rays whose number is smaller already, `equal` those
// that agree so far.
layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 5) writeonly buffer Grid { uint grid[]; };

layout(constant_id = 3) const uint k_digits = 10;  // of the numbers 0 … N_α; at least 3, at most 21
const uint k_low_digits = 3u;                      // the numbers whose words are written in one go: 2³

void main() {
  uint word = gl_GlobalInvocationID.x;
  uint j = gl_GlobalInvocationID.y;
  if (word >= k_words_per_ray || j >= k_theta_count) return;

  // Where the shadow of each of the 32 light rays starts.
  float theta = theta_centre(j, k_theta_count);
  vec3 outward = cos(theta) * space.u + sin(theta) * space.f;
  PhiCells cells = phi_cells();
  uint slice[k_digits];
  for (uint b = 0u; b < k_digits; ++b) slice[b] = 0u;
  for (uint bit = 0u; bit < 32u; ++bit) {
    uint first = first_shadowed_on(outward, phi_of_cell(cells, float(32u * word + bit) + 0.5));
    for (uint b = 0u; b < k_digits; ++b) slice[b] |= (first >> b & 1u) << bit;
  }

  // The words of all α, eight at a time.
  uint at = grid_word(0u, j, word, k_alpha_count, k_words_per_ray);
  for (uint i = 0u; i < k_alpha_count; i += 8u) {
    uint below = 0u;
    uint equal = 0xffffffffu;
    for (uint b = k_digits - 1u; b >= k_low_digits; --b) {
      uint digit = 0u - (i >> b & 1u);  // all ones or none
      below |= equal & ~slice[b] & digit;
      equal &= ~(slice[b] ^ digit);
    }
    // first's low digits ≤ 0, 1, … 7
    uint zero1 = ~slice[1];
    uint zero0 = ~slice[0];
    uint zero2 = equal & ~slice[2];
    uint words[8] = uint[8](below | (zero2 & zero1 & zero0), below | (zero2 & zero1), below | (zero2 & (zero1 | zero0)),
                            below | zero2, below | zero2 | (equal & zero1 & zero0), below | zero2 | (equal & zero1),
                            below | zero2 | (equal & (zero1 | zero0)), below | equal);
    for (uint low = 0u; low < 8u; ++low) {
      if (i + low < k_alpha_count) grid[at] = words[low];
      at += k_words_per_ray;
    }
  }
}
