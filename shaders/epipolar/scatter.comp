#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/grid.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/window.glsl"

// Sets the bit of the first shadowed cell of every light ray: V(α_d, θ_j, φ_k) = 1 (section 4.1.3). An invocation owns 32
// neighbouring φ of one plane, and with them the words that it writes, so no atomics are needed. The grid must be clear.
layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = k_first_shadowed_unit) uniform usamplerBuffer first_shadowed;  // four light rays a texel
layout(std430, binding = k_grid_storage) buffer Grid { uint grid[]; };

void main() {
  uint word = gl_GlobalInvocationID.x;
  uint plane = gl_GlobalInvocationID.y;
  if (word >= k_words_per_ray || plane >= window_planes) return;
  int rays = int(((window_first_plane + plane) * k_words_per_ray + word) * 8u);
  for (uint bit = 0u; bit < 32u; bit += 4u) {
    uvec4 first = texelFetch(first_shadowed, rays + int(bit >> 2));
    for (uint i = 0u; i < 4u; ++i) {
      if (first.x < k_alpha_count) grid[grid_word(first.x, plane, word, k_alpha_count, k_words_per_ray)] |= 1u << (bit + i);
      first.xyz = first.yzw;
    }
  }
}
