// Included in a namespace of the shaders' functions, once for each arithmetic.

/// Voxelizes one triangle as the compute shaders do. `cells_of` gives a plane's cells of φ. Corners are
/// relative to the eye; `note` is told of (plane, cell of φ, first cell of α).
template <class CellsOf, class Note>
void voxelize_triangle(const EpipolarBlock& space, const CellsOf& cells_of, const vec3& a, const vec3& b,
                       const vec3& c, uint alpha_count, uint theta_count, const Note& note) {
  using Number = decltype(space.distance);
  const VoxelTriangle triangle = voxel_triangle(space, a, b, c, theta_count);
  const uint slabs = slabs_per_plane(space);
  for (uint index = 0; index < plane_count(triangle.planes); ++index) {
    const uint plane = plane_at(triangle.planes, index);
    const PhiCells cells = cells_of(plane);
    const Angle border = theta_of_plane(space, Cell(Number(plane)));
    const Angle step = (theta_of_plane(space, Cell(Number(plane + 1))) - border) / Number(slabs);
    for (uint slab = 0; slab < slabs; ++slab) {
      const Angle from_theta = border + Number(slab) * step;
      const SlabPart part = part_in_slab(space, cells, triangle, from_theta, from_theta + step);
      vec3 from = boundary_ray(space, cells, part.first_ray);
      for (uint k = part.first_ray; k < part.end_ray; ++k) {
        const vec3 to = boundary_ray(space, cells, k + 1);
        const uint first = first_touched_cell(space, part, from, to, alpha_count);
        if (first < alpha_count) note(plane, k, first);
        from = to;
      }
    }
  }
}
