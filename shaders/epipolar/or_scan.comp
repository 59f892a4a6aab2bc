#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/grid.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/window.glsl"

// V(α_i) |= V(α_{i−1}) along α, for all (θ, φ) (Eq. 3): one invocation walks 128 light rays of one plane outwards.
layout(local_size_x = 4, local_size_y = 4) in;  // neighbours in x share cache lines
layout(binding = k_grid_unit) uniform usamplerBuffer grid_texels;  // the same bits: a texel is read only by who writes it later
layout(std430, binding = k_grid_storage) writeonly buffer Grid { uvec4 grid[]; };

void main() {
  uint texel = gl_GlobalInvocationID.x;
  uint plane = gl_GlobalInvocationID.y;
  if (texel >= k_texels_per_ray || plane >= window_planes) return;
  uvec4 shadow = uvec4(0u);
  uint at = plane * k_alpha_count * k_texels_per_ray + texel;
  uint before = window_first_plane * k_alpha_count * k_texels_per_ray;  // texels before the window
  for (uint i = 0u; i < k_alpha_count; ++i) {
    shadow |= texelFetch(grid_texels, int(before + at));
    grid[at] = shadow;
    at += k_texels_per_ray;
  }
}
