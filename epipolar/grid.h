#pragma once

#include <array>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::epipolar {

/// How many cells the grid has along each angle. Memory is alpha · theta · phi / 8 bytes. By default a
/// quarter of the paper's 512 × 2048 × 512: docs/figures.md has what that saves and costs.
struct Resolution {
  int alpha = 256;   ///< view rays a plane: too few show as jagged shadow edges
  int theta = 1024;  ///< epipolar half-planes: too few show as streaks around the epipole
  int phi = 512;  ///< samples a view ray, a multiple of 128: too few show as noise and missed thin occluders
  bool operator==(const Resolution&) const = default;
};

/// Beyond any image; whether the driver can hold the product of the counts is for Grid to find out.
inline constexpr int k_largest_count = 1 << 17;

/// @throws scene::Error (usage) when a count is not positive or `phi` is not a multiple of 128.
void validate(const Resolution& resolution);

/// The specialization constants of shaders/epipolar/resolution.glsl.
std::array<gpu::Constant, 3> resolution_constants(const Resolution& resolution);

/// A run of half-planes whose bits, and whose mip chain, fit into one shader storage buffer, and which one
/// dispatch takes.
struct Window {
  int first_plane, planes;
};

/// The grid's bits and the frame's ranges, on the GPU; see shaders/epipolar/grid.glsl.
///
/// Shaders read all bits as texels. They write them a window at a time, because one storage buffer may be
/// small: 128 MiB on llvmpipe. `limits` need not be all that the driver allows.
class Grid {
 public:
  /// @param has_bits else they are of size 0, and what depends on them is not to be called
  /// @throws scene::Error (driver) when the driver cannot hold the grid, naming its limit.
  Grid(const gpu::Limits& limits, const Resolution& resolution, bool has_bits = true);

  const Resolution& resolution() const { return resolution_; }
  const gpu::Buffer& bits() const { return bits_; }
  const gpu::Buffer& block() const { return block_; }          ///< EpipolarBlock
  const gpu::Buffer& phi_range() const { return phi_range_; }  ///< see shaders/epipolar/phi_range.glsl

  const gpu::Buffer& planes() const { return planes_; }          ///< see shaders/epipolar/planes.glsl
  const gpu::Buffer& box_ranges() const { return box_ranges_; }  ///< a vec2 a plane: epipolar::box_ranges

  /// Binds those as texels (k_scratch_unit).
  void bind_box_ranges() const;

  /// For each light ray (θ_j, φ_k), at index j·N_φ + k, the first cell of α in shadow; N_α where none is.
  const gpu::Buffer& first_shadowed() const { return first_shadowed_; }

  /// Binds the block, the φ range, the first shadowed cells, the planes, and as texels what view rays are
  /// answered from: the bits, or without them the first shadowed cells (shaders/bindings.glsl).
  void bind() const;

  /// What all planes together consist of.
  const std::vector<Window>& windows() const { return windows_; }

  /// Binds the bits of a window for writing.
  void bind_window(const Window& window) const;

 private:
  Resolution resolution_;
  std::vector<Window> windows_;
  gpu::Buffer bits_, block_, phi_range_, planes_, box_ranges_, first_shadowed_;
  gpu::TexelView texels_, plane_texels_, box_range_texels_, first_shadowed_texels_;
};

/// Makes a window what a program works on whose shader includes shaders/epipolar/window.glsl.
void set_window(const gpu::Pipeline& program, const Window& window);

/// Runs such a program once a window over `invocations_x` × planes.
void dispatch_planes(const gpu::Pipeline& program, const Grid& grid, int invocations_x);

}  // namespace airlight::epipolar
