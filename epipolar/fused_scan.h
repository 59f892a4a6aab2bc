#pragma once

#include "epipolar/grid.h"
#include "gpu/pipeline.h"

namespace airlight::epipolar {

/// Turns the first shadowed cell of every light ray into the scanned grid: what scattering one bit a light
/// ray and OrScan do, bit for bit.
///
/// Bound by the writes alone: at most N_α · N_θ · N_φ / 8 bytes, each texel once, and none before the first
/// shadow on its 128 light rays. Our own; the paper clears, scatters and scans.
class FusedScan {
 public:
  explicit FusedScan(const Resolution& resolution);

  /// Overwrites the whole grid from `grid.first_shadowed()`. The grid is bound.
  void run(const Grid& grid) const;

 private:
  gpu::Pipeline program_;
};

}  // namespace airlight::epipolar
