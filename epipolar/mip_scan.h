#pragma once

#include <vector>

#include "epipolar/grid.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::epipolar {

/// The paper's scan in many passes (Wyman 2011, section 2.2.2, after Harris et al., GPU Gems 3, chapter 39):
/// up a chain of mip levels along α, each entry the OR of two below, and down again, adding to each entry
/// what lies before it. Does what OrScan does, bit for bit, and leaves the scanned levels in `chain`.
///
/// 2 ⌈log₂ N_α⌉ passes that together read and write about five times the grid; each pass is as parallel as
/// the level is large.
class MipScan {
 public:
  MipScan(const gpu::Limits& limits, const Grid& grid);

  /// The grid is bound.
  void run(const Grid& grid) const;

  std::int64_t bytes() const { return chain_.bytes(); }

 private:
  struct Level {
    std::uint32_t size, start;  ///< entries in α, and where they start in a plane's chain
  };
  struct Programs {
    gpu::Pipeline up, down;
  };
  void pass(const gpu::Pipeline& program, std::size_t fine, std::uint32_t entries, const Grid& grid,
            const Window& window) const;

  std::vector<Level> levels_;  ///< level 0 is the grid, which is not in the chain
  std::uint32_t chain_size_ = 0;
  gpu::Buffer chain_;
  gpu::TexelView chain_texels_;
  Programs of_grid_, of_chain_;
};

}  // namespace airlight::epipolar
