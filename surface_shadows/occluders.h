#pragma once

#include <cstdint>
#include <vector>

#include "frame/method.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"

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

/// The triangles of a scene as the predicate wants them (shaders/frame/occlusion.glsl): relative to the
/// light, scaled by a power of two, corners turned; made anew for each light of each frame.
class Occluders {
 public:
  explicit Occluders(Culling culling);

  /// Makes them for the light of `inputs`. The frame's blocks are bound.
  /// @throws scene::Error (driver) for more triangles than one storage block of the driver holds
  void build(const frame::FrameInputs& inputs);

  /// Binds what shaders/surface_shadows/occluders.glsl reads.
  void bind(const frame::FrameInputs& inputs) const;

  std::uint32_t count() const { return count_; }

  /// What positions relative to the light are multiplied by: their products of three stay below the largest
  /// float.
  float scale() const { return scale_; }

  /// No point of the scene is farther from the light, under a sun from the eye; scaled, rounded up.
  float reach() const { return reach_; }

  std::int64_t bytes() const { return corners_.bytes() + parts_.bytes() + is_culled_.bytes(); }

 private:
  void load(const frame::FrameInputs& inputs);
  /// Which of `boxes_` have neither the eye nor the light inside, into `is_culled_`.
  void cull_parts(const frame::FrameInputs& inputs) const;

  Culling culling_;
  gpu::Pipeline program_;
  std::uint64_t scene_ = 0;  ///< SceneBuffers::id
  std::uint32_t count_ = 0;
  gpu::Buffer corners_;
  gpu::TexelView corner_texels_;
  float scale_ = 1.0f, reach_ = 0.0f;

  // Without culling they hold nothing.
  std::vector<scene::Box> boxes_;  ///< of the parts that have two sides
  gpu::Buffer parts_;              ///< of each triangle, which of them it is of, from 1; 0 for none
  gpu::Buffer is_culled_;          ///< of each part; 0 of none
  gpu::TexelView part_texels_, is_culled_texels_;
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

/// What to do about a model whose triangles one storage block does not hold.
inline constexpr const char* k_storage_remedy = "render a smaller model, or take another method";

}  // namespace airlight::surface_shadows
