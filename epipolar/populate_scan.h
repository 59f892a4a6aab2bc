#pragma once

#include "epipolar/grid.h"
#include "frame/shadow_map.h"
#include "gpu/program.h"

namespace airlight::epipolar {

/// Populates the grid from the shadow map and scans it in the same pass: what PopulateShadowMap and OrScan
/// do, bit for bit.
///
/// Bound by the writes alone: N_α · N_θ · N_φ / 8 bytes, each word once. Our own; the paper clears, scatters
/// and scans.
class PopulateScan {
 public:
  explicit PopulateScan(const Resolution& resolution);

  /// Overwrites the whole grid. The view's block and the grid are bound.
  void run(const Grid& grid, const frame::ShadowMap& shadow_map) const;

 private:
  gpu::Program program_;
};

}  // namespace airlight::epipolar
