#pragma once

#include "epipolar/grid.h"
#include "epipolar/or_scan.h"
#include "epipolar/populate_shadow_map.h"
#include "frame/methods.h"

namespace airlight::epipolar {

/// The voxelized shadow volume of a frame: ranges → populate → scan. Afterwards the bit of voxel (α_i, θ_j, φ_k) says
/// whether its centre is in shadow.
/// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, section 2.2.
class ShadowVolume {
 public:
  ShadowVolume(const gpu::Context& context, const Resolution& resolution);

  /// Builds the volume for a view; `inputs.shadow_map` must be there. Times `ranges`, `populate` and `scan`. Leaves the
  /// grid bound.
  void build(const frame::FrameInputs& inputs) const;

  const Grid& grid() const { return grid_; }

 private:
  Grid grid_;
  gpu::Program phi_range_;
  PopulateShadowMap populate_;
  OrScan scan_;
};

}  // namespace airlight::epipolar
