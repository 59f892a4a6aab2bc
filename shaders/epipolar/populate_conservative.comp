#version 450
#extension GL_GOOGLE_include_directive : require

// Every voxel that a triangle touches, or what of it matters: the first on each light ray.
#include "epipolar/uniforms.glsl"
#include "epipolar/conservative.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"

#define TRIANGLE VoxelTriangle
#include "epipolar/triangle_queue.glsl"

layout(std430, binding = k_first_shadowed_storage) buffer FirstShadowed { uint first_shadowed[]; };

VoxelTriangle fetch_triangle(uint index) {
  uvec3 corners = texelFetch(triangles, int(index)).xyz;
  return voxel_triangle(space, eye_relative(camera, texelFetch(positions, int(corners.x)).xyz),
                        eye_relative(camera, texelFetch(positions, int(corners.y)).xyz),
                        eye_relative(camera, texelFetch(positions, int(corners.z)).xyz), k_theta_count);
}

// Notes the part of a triangle in the cell of the `index`th of its planes.
void voxelize_in_plane(VoxelTriangle triangle, uint index) {
  uint plane = plane_at(triangle.planes, index);
  PhiCells cells = phi_cells(plane);
  vec2 borders = plane_borders(plane);
  uint slabs = slabs_per_plane(space);
  float slab_step = (borders.y - borders.x) / float(slabs);
  for (uint slab = 0u; slab < slabs; ++slab) {
    float from = borders.x + float(slab) * slab_step;
    SlabPart part = part_in_slab(space, cells, triangle, from, from + slab_step);
    vec3 from_ray = boundary_ray(space, cells, part.first_ray);
    for (uint k = part.first_ray; k < part.end_ray; ++k) {
      vec3 to_ray = boundary_ray(space, cells, k + 1u);
      uint first = first_touched_cell(space, part, from_ray, to_ray, k_alpha_count);
      if (first < k_alpha_count) atomicMin(first_shadowed[plane * k_phi_count + k], first);
      from_ray = to_ray;
    }
  }
}

#include "epipolar/triangle_passes.glsl"
