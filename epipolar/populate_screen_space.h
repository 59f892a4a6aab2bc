#pragma once

#include <vector>

#include "epipolar/grid.h"
#include "epipolar/triangle_queue.h"
#include "frame/methods.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::epipolar {

/// Populates the grid with solids, by the number of surfaces that each of its view rays crosses (Wyman 2011,
/// section 2.2.1, after Eisemann and Décoret, "Fast Scene Voxelization and Applications", I3D 2006). Right
/// for watertight parts; an open one gives shadow and light where there is none (scene/components.h counts
/// why).
///
/// Parts that may interpenetrate are voxelized on their own, because where two solids overlap their crossings
/// cancel: the parts are dealt into passes such that the boxes of those in one pass are apart.
/// Deviation: the paper rasterises and XORs masks in the blending stage; here a compute shader flips one bit
/// a crossing, and a second one the bits before it.
class PopulateScreenSpace {
 public:
  PopulateScreenSpace(const gpu::Limits& limits, const Grid& grid);

  /// Clears the grid and sets the bits inside solids. The view's block and the grid are bound.
  void run(const frame::FrameInputs& inputs, const Grid& grid);

  std::int64_t bytes() const { return flips_.bytes() + triangles_.bytes(); }

 private:
  struct Pass {
    std::uint32_t first, count;  ///< triangles
  };
  void load(const frame::FrameInputs& inputs);

  gpu::Limits limits_;
  TriangleQueue crossings_;
  gpu::Pipeline resolve_;
  gpu::Buffer flips_;
  gpu::TexelView flip_texels_;
  std::uint64_t scene_ = 0;  ///< whose triangles these are: SceneBuffers::id
  gpu::Buffer triangles_;
  gpu::TexelView triangle_texels_;
  std::vector<Pass> passes_;
};

/// Deals boxes into as few groups as a greedy sweep finds, such that no two of a group touch.
/// @returns the group of each box, from 0
std::vector<std::uint32_t> deal_apart(const std::vector<scene::Box>& boxes);

}  // namespace airlight::epipolar
