#pragma once

#include "epipolar/grid.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::epipolar {

/// Cells of α, of which a node holds the numbers in 16 bits, and that of none beside them.
inline constexpr int k_tree_alpha = 65535;
/// The most light rays of a half-plane: a walk keeps four bits a level in 32.
inline constexpr int k_most_tree_phi = 65536;

/// For each half-plane a tree over its light rays, in which a view ray finds where its visibility changes:
/// see shaders/epipolar/change_tree.glsl. It takes the place of the grid's bits. Based on: Chen, Baran,
/// Durand and Jarosz, "Real-Time Volumetric Shadows using 1D Min-Max Mipmaps", I3D 2011. Deviation: theirs is
/// binary, and a node knows its own samples alone, so that a descent ends where all of them are lit, or all
/// are dark. Here a node knows its left neighbour's last sample as well: then one that a view ray straddles
/// holds a change, and no descent is in vain.
class ChangeTree {
 public:
  /// @throws scene::Error (driver) when the driver cannot hold the tree, naming its limit.
  ChangeTree(const gpu::Limits& limits, const Resolution& resolution);

  /// Makes it from the grid's first shadowed cells. Both are bound.
  void build() const;

  /// Binds it as texels, in the place of the grid's bits (shaders/bindings.glsl).
  void bind() const;

  const gpu::Buffer& nodes() const { return nodes_; }

 private:
  Resolution resolution_;
  gpu::Buffer nodes_;
  gpu::TexelView texels_;
  gpu::Pipeline program_;
};

}  // namespace airlight::epipolar
