// Two neighbouring levels of the chain of the multi-pass scan. GLSL only.
//
// Level 0 is the grid; level m + 1 has one entry for each pair of neighbours in α of level m. The levels above 0 lie one after
// the other, plane by plane, for the planes of a window.
#include "epipolar/resolution.glsl"
#include "epipolar/window.glsl"

layout(local_size_x = 32, local_size_y = 2) in;
layout(constant_id = 3) const uint k_fine_is_grid = 0;
layout(binding = k_grid_unit) uniform usamplerBuffer grid_texels;
layout(binding = k_scratch_unit) uniform usamplerBuffer chain_texels;
layout(std430, binding = k_grid_storage) writeonly buffer Grid { uvec4 grid[]; };
layout(std430, binding = k_scratch_storage) writeonly buffer Chain { uvec4 chain[]; };

uint chain_index(uint plane, uint entry, uint texel) {
  return (plane * chain_size + entry) * k_texels_per_ray + texel;
}

uvec4 fine_texel(uint plane, uint i, uint texel) {
  if (k_fine_is_grid != 0u) {
    return texelFetch(grid_texels, int(((window_first_plane + plane) * k_alpha_count + i) * k_texels_per_ray + texel));
  }
  return texelFetch(chain_texels, int(chain_index(plane, fine_start + i, texel)));
}

uvec4 coarse_texel(uint plane, uint i, uint texel) {
  return texelFetch(chain_texels, int(chain_index(plane, coarse_start + i, texel)));
}
