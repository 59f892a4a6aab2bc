#pragma once

#include "epipolar/grid.h"
#include "frame/shadow_map.h"
#include "gpu/pipeline.h"

namespace airlight::epipolar {

/// Populates the grid by resampling the shadow map (Wyman 2011, section 4.1.3): one look-up a light ray, the
/// bit of the nearest occluder. Robust for anything that can be rasterised; as exact as the shadow map.
class PopulateShadowMap {
 public:
  explicit PopulateShadowMap(const Resolution& resolution);

  /// Overwrites `grid.first_shadowed()`. The view's block and the grid are bound.
  void run(const Grid& grid, const frame::ShadowMap& shadow_map) const;

 private:
  gpu::Pipeline program_;
};

}  // namespace airlight::epipolar
