#pragma once

#include "epipolar/grid.h"
#include "gpu/pipeline.h"

namespace airlight::epipolar {

/// Extends every set bit along its light ray, away from the light: afterwards a bit says that its voxel is in
/// shadow (Wyman 2011, section 2.2.2, Eq. 3).
///
/// Deviation: one pass that walks each column of α once, instead of the paper's 2 log₂ N_α passes (MipScan).
/// It reads and writes each texel once; with N_θ · N_φ / 128 columns there is work enough for every lane.
class OrScan {
 public:
  explicit OrScan(const Resolution& resolution);

  /// The grid is bound.
  void run(const Grid& grid) const;

 private:
  gpu::Pipeline program_;
};

}  // namespace airlight::epipolar
