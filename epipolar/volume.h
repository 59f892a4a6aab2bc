#pragma once

#include <optional>

#include "epipolar/grid.h"
#include "epipolar/or_scan.h"
#include "epipolar/populate_scan.h"
#include "epipolar/populate_shadow_map.h"
#include "epipolar/space_math.h"
#include "frame/methods.h"

namespace airlight::epipolar {

/// How the grid is populated and scanned.
enum class Scan {
  fused,   ///< PopulateScan: both in one pass
  column,  ///< PopulateShadowMap, then OrScan
};

/// The voxelized shadow volume of a frame: ranges → populate → scan. Afterwards the bit of voxel (α_i, θ_j,
/// φ_k) says whether its centre is in shadow. Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011,
/// section 2.2.
class ShadowVolume {
 public:
  ShadowVolume(const gpu::Context& context, const Resolution& resolution, Scan scan);

  /// Finds the ranges of α and φ for a view, and cuts φ equally. Times `ranges`. Leaves the grid bound.
  /// @returns what it wrote to the grid's block
  shaders::EpipolarBlock find_ranges(const frame::FrameInputs& inputs) const;

  /// Populates and scans; `inputs.shadow_map` must be there, the grid bound. Times `populate` and `scan`, or
  /// `populate_scan`.
  void fill(const frame::FrameInputs& inputs) const;

  const Grid& grid() const { return grid_; }

 private:
  Grid grid_;
  gpu::Program phi_range_;
  std::optional<PopulateScan> populate_scan_;
  std::optional<PopulateShadowMap> populate_;
  std::optional<OrScan> scan_;
};

}  // namespace airlight::epipolar
