#pragma once

#include <cstdint>

#include "frame/method.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "surface_shadows/culled_parts.h"

namespace airlight::surface_shadows {

/// How positions relative to the light are written.
struct LightScale {
  float scale = 1.0f;  ///< they are multiplied by this power of two: products of three then stay finite
  /// No point of the scene is farther from the light, under a sun from the eye; scaled, rounded up.
  float reach = 0.0f;

  /// More than the roundings of such positions [m].
  double margin() const { return 1e-6 * static_cast<double>(reach / scale); }
};
LightScale light_scale(const frame::FrameInputs& inputs);

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

  /// See LightScale.
  float scale() const { return scale_.scale; }
  float reach() const { return scale_.reach; }

  std::int64_t bytes() const { return corners_.bytes() + parts_.bytes() + culled_parts_.bytes(); }

 private:
  void load(const frame::FrameInputs& inputs);

  Culling culling_;
  bool culls_ = false;  ///< of the scene: where light passes a part, both of its sides count
  gpu::Pipeline program_;
  std::uint64_t scene_ = 0;  ///< SceneBuffers::id
  std::uint32_t count_ = 0;
  gpu::Buffer corners_;
  gpu::TexelView corner_texels_;
  LightScale scale_;

  // Without culling they hold nothing.
  CulledParts culled_parts_;
  gpu::Buffer parts_;  ///< of each triangle
  gpu::TexelView part_texels_;
};

/// What to do about a model whose triangles one storage block does not hold.
inline constexpr const char* k_storage_remedy = "render a smaller model, or take another method";

}  // namespace airlight::surface_shadows
