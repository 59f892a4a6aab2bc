#pragma once

#include "epipolar/grid.h"
#include "epipolar/triangle_queue.h"
#include "frame/scene_buffers.h"

namespace airlight::epipolar {

/// Populates the grid by conservative voxelization of the triangles (Wyman 2011, sections 2.2.1 and 4.1.2):
/// every voxel that a triangle touches is shadowed, as is what lies behind it, so no light leaks through any
/// triangle soup. See shaders/epipolar/conservative.glsl.
///
/// Deviation: only the voxel nearest the light of each light ray (θ_j, φ_k) is noted; the scan would set
/// those behind it anyway. So a triangle costs one atomic minimum a light ray that it meets, into
/// 4 · N_θ · N_φ bytes, instead of one a voxel into the whole grid.
class PopulateConservative {
 public:
  explicit PopulateConservative(const Resolution& resolution);

  /// Overwrites `grid.first_shadowed()`. The view's block and the grid are bound.
  /// @param left_out triangle numbers, sorted
  void run(const Grid& grid, const frame::SceneBuffers& scene, std::span<const std::uint32_t> left_out);

 private:
  TriangleQueue triangles_;
};

}  // namespace airlight::epipolar
