#pragma once

#include <cstdint>
#include <vector>

#include "frame/method.h"
#include "gpu/buffer.h"

namespace airlight::surface_shadows {

/// Which triangles are left out before any is asked.
enum class Culling {
  none,
  /// Those that face the light, of parts that have two sides and eye and light outside of them
  /// (scene::Components::has_two_sides). What they hide is hidden by others of their part, too: a ray from
  /// the light that comes out of a part again has crossed it once from its back for every time from its
  /// front. That holds for what the eye sees. Rasterisation shows a little more: at a silhouette the inner
  /// side of a part, and where two touch what lies just within the other; what hides that is left out.
  automatic,
};

/// Whether anything is to be left out of a scene: where light passes a part, both of its sides count.
inline bool culls(Culling culling, const frame::SceneBuffers& scene) {
  return culling == Culling::automatic && !scene.transmits();
}

/// The parts of a scene whose triangles that face the light may be left out, those that have two sides; and
/// whether they are, for each light of each frame.
class CulledParts {
 public:
  /// Of a scene, once.
  explicit CulledParts(const frame::FrameInputs& inputs);
  CulledParts() = default;

  /// Which part each triangle is of, from 1, in the order of the scene's buffers; 0 for one that is always
  /// asked.
  const std::vector<std::uint32_t>& of_triangle() const { return of_triangle_; }

  /// Finds those that have neither the eye nor the light inside.
  /// @param margin more than the roundings of positions relative to the light [m]
  void find(const frame::FrameInputs& inputs, double margin) const;

  /// Binds whether each part is culled: shaders::k_is_culled_unit.
  void bind() const;

  std::int64_t bytes() const { return is_culled_.bytes(); }

 private:
  std::vector<scene::Box> boxes_;
  std::vector<std::uint32_t> of_triangle_;
  gpu::Buffer is_culled_;  ///< of each part; 0 of none
  gpu::TexelView is_culled_texels_;
};

/// The option `cull` of a method whose options have a field for it.
template <class Options>
frame::Option culling_option(Culling Options::*field) {
  return frame::word_option<Options, Culling>(
      {.name = "cull",
       .meaning = "which triangles are left out beforehand",
       .quality = "auto: up to three pixels in ten thousand, where parts touch and at silhouettes",
       .cost = "auto asks half as many triangles of closed parts",
       .sweep = {"none", "auto"}},
      {{"none", "none"}, {"auto", "those that face the light, of closed parts around neither eye nor light"}},
      field);
}

}  // namespace airlight::surface_shadows
