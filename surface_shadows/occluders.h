#pragma once

#include <cstdint>

#include "frame/methods.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace airlight::surface_shadows {

/// The triangles of a scene as the predicate wants them (shaders/frame/occlusion.glsl): relative to the
/// light, scaled by a power of two, corners turned; made anew for each light of each frame.
class Occluders {
 public:
  Occluders();

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

  std::int64_t bytes() const { return corners_.bytes(); }

 private:
  gpu::Pipeline program_;
  std::uint64_t scene_ = 0;  ///< SceneBuffers::id
  std::uint32_t count_ = 0;
  gpu::Buffer corners_;
  gpu::TexelView corner_texels_;
  float scale_ = 1.0f, reach_ = 0.0f;
};

/// What to do about a model whose triangles one storage block does not hold.
inline constexpr const char* k_storage_remedy = "render a smaller model, or take another method";

}  // namespace airlight::surface_shadows
