#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/view.glsl"
#include "frame/shadow_cube.glsl"
#include "epipolar/grid.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "epipolar/light_ray_occluder.glsl"

// For each light ray (θ_j, φ_k): the nearest occluder of the shadow map, at α_d, sets the bit of the first cell in its
// shadow (section 4.1.3). An invocation owns 32 neighbouring φ of one plane, and with them the words that it writes, so no
// atomics are needed. The grid must be clear.
layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 5) buffer Grid { uint grid[]; };

void main() {
  uint word = gl_GlobalInvocationID.x;
  uint j = gl_GlobalInvocationID.y;
  if (word >= k_words_per_ray || j >= k_theta_count) return;

  float theta = theta_centre(j, k_theta_count);
  vec3 outward = cos(theta) * space.u + sin(theta) * space.f;
  PhiCells cells = phi_cells();
  for (uint bit = 0u; bit < 32u; ++bit) {
    uint first = first_shadowed_on(outward, phi_of_cell(cells, float(32u * word + bit) + 0.5));
    if (first < k_alpha_count) grid[grid_word(first, j, word, k_alpha_count, k_words_per_ray)] |= 1u << bit;
  }
}
