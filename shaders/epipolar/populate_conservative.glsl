// What the two passes of the conservative voxelization share. GLSL only.
#include "frame/view.glsl"
#include "epipolar/conservative.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"

layout(std140, binding = 0) uniform ViewUniform { ViewBlock view; };
layout(std140, binding = 1) uniform EpipolarUniform { EpipolarBlock space; };
layout(binding = 8) uniform samplerBuffer positions;   // vec3, world space
layout(binding = 9) uniform usamplerBuffer triangles;  // uvec3, indices of positions
layout(std430, binding = 7) buffer FirstShadowed { uint first_shadowed[]; };

// Triangles that touch many slabs, left by the first pass for the second: `many`, from the front, some hundreds of slabs at
// most, `most`, from the back, more.
layout(std430, binding = 8) buffer Queue {
  uvec3 many_groups;  // of an indirect dispatch: k_row × rows × 1 groups, one a triangle
  uint many_count;
  uvec3 most_groups;
  uint most_count;
  uint triangle_count;
  uint queue[];
};

const uint k_row = 256u;

VoxelTriangle fetch_triangle(uint index) {
  uvec3 corners = texelFetch(triangles, int(index)).xyz;
  return voxel_triangle(space, eye_relative(view, texelFetch(positions, int(corners.x)).xyz),
                        eye_relative(view, texelFetch(positions, int(corners.y)).xyz),
                        eye_relative(view, texelFetch(positions, int(corners.z)).xyz), k_theta_count);
}

// Notes the part of a triangle in the `index`th of its slabs.
void voxelize_in_slab(VoxelTriangle triangle, uint index) {
  PhiCells cells = phi_cells();
  SlabPart part = part_in_slab(space, cells, triangle, index);
  vec2 from_ray = boundary_ray(cells, part.first_ray);
  for (uint k = part.first_ray; k < part.end_ray; ++k) {
    vec2 to_ray = boundary_ray(cells, k + 1u);
    uint first = first_touched_cell(space, part, from_ray, to_ray, k_alpha_count);
    if (first < k_alpha_count) atomicMin(first_shadowed[part.plane * k_phi_count + k], first);
    from_ray = to_ray;
  }
}
