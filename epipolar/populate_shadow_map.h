#pragma once

#include <array>
#include <optional>

#include "epipolar/grid.h"
#include "frame/methods.h"
#include "gpu/pipeline.h"

namespace airlight::epipolar {

/// Populates the grid by resampling the shadow map (Wyman 2011, section 4.1.3): one look-up a light ray, the
/// bit of the nearest occluder. Robust for anything that can be rasterised; as exact as the shadow map.
class PopulateShadowMap {
 public:
  /// Overwrites `grid.first_shadowed()`. The view's block and the grid are bound.
  /// @param reach see FrameInputs::shadow_map
  void run(const Grid& grid, const frame::FrameInputs& inputs, double reach);

 private:
  std::array<std::optional<gpu::Pipeline>, 2> programs_;  ///< by: the shadow map is on a plane
};

}  // namespace airlight::epipolar
