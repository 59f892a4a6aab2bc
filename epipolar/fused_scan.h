#pragma once

#include "epipolar/grid.h"
#include "gpu/pipeline.h"

namespace airlight::epipolar {

/// The numbers of a block's rows have 16 bits each.
inline constexpr int k_most_block_alpha = 1 << 16;

/// Turns the first shadowed cell of every light ray into the scanned grid: what scattering one bit a light
/// ray and OrScan do, bit for bit.
///
/// Bound by the writes alone: at most N_α · N_θ · N_φ / 8 bytes, each texel once, and none before the first
/// shadow on its 128 light rays. Our own; the paper clears, scatters and scans.
///
/// By blocks: of the 128 light rays of a texel, a block, only the rows of α are stored from the last one that
/// is wholly lit to the first one that is wholly dark. All before are like the one, all beyond like the
/// other, and shaders/epipolar/grid_texels.glsl reads those instead. The rest of the grid holds anything.
class FusedScan {
 public:
  /// @param by_blocks with N_α ≤ k_most_block_alpha
  FusedScan(const gpu::Limits& limits, const Resolution& resolution, bool by_blocks);

  /// Scans from `grid.first_shadowed()`, whatever the grid holds. The grid is bound.
  void run(const Grid& grid) const;

  /// Binds the blocks, if any, as texels and for writing (shaders/bindings.glsl).
  void bind() const;

  /// For each block, at index j·N_φ/128 + block, its first row that is stored and, in the high half, its
  /// last; empty if not by blocks.
  const gpu::Buffer& blocks() const { return blocks_; }

  /// All bits of a grid that `run` has scanned, those that blocks leave out, too.
  std::vector<std::uint32_t> bits(const Grid& grid) const;

  /// What `run` wrote to the grid [bytes].
  std::int64_t written_bytes(const Grid& grid) const;

 private:
  gpu::Pipeline program_;
  gpu::Buffer blocks_;
  gpu::TexelView block_texels_;
};

}  // namespace airlight::epipolar
