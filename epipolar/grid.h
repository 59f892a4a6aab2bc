#pragma once

#include <array>

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/texture.h"

namespace airlight::epipolar {

/// How many cells the grid has along each angle. Memory is alpha · theta · phi / 8 bytes.
struct Resolution {
  int alpha = 512;   ///< view rays a plane: too few show as jagged shadow edges
  int theta = 2048;  ///< epipolar half-planes: too few show as streaks around the epipole
  int phi = 512;  ///< samples a view ray, a multiple of 128: too few show as noise and missed thin occluders
  bool operator==(const Resolution&) const = default;
};

/// @throws scene::Error (usage) when a count is not positive or `phi` is not a multiple of 128.
void validate(const Resolution& resolution);

/// The specialization constants of shaders/epipolar/resolution.glsl.
std::array<gpu::Constant, 3> resolution_constants(const Resolution& resolution);

/// The grid's bits and the frame's ranges, on the GPU; see shaders/epipolar/grid.glsl.
class Grid {
 public:
  /// @throws scene::Error (driver) when the grid is larger than one shader storage buffer may be.
  Grid(const gpu::Context& context, const Resolution& resolution);

  const Resolution& resolution() const { return resolution_; }
  const gpu::Buffer& bits() const { return bits_; }
  const gpu::Buffer& block() const { return block_; }          ///< EpipolarBlock
  const gpu::Buffer& phi_range() const { return phi_range_; }  ///< see shaders/epipolar/phi_range.glsl

  /// Binds the block to uniform binding 1, the φ range to storage binding 4, the bits to storage binding 5
  /// and, as texels, to sampler 12.
  void bind() const;

 private:
  Resolution resolution_;
  gpu::Buffer bits_, block_, phi_range_;
  gpu::TexelView texels_;
};

}  // namespace airlight::epipolar
