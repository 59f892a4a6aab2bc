#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>

#include "frame/method.h"
#include "frame/screen_pass.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"
#include "media/lighting.h"

namespace airlight::media {

struct FroxelOptions {
  int tile = 8;  ///< side of a froxel [pixels]
  int slices = 64;
  int samples = 1;  ///< look-ups a froxel

  bool needs_shadow_map() const { return true; }
  /// A phase function whose lobe is too narrow.
  std::optional<frame::Refusal> refusal(const scene::View& view) const { return narrow_lobe(view.medium); }
};

/// How many froxels there are, along the image's sides and in depth.
/// @throws scene::Error (driver), naming the option, for more than a 3D texture may have
glm::ivec3 froxel_count(const gpu::Limits& limits, const FroxelOptions& options, glm::ivec2 image_size);

/// The depth along the view's direction at which the last slice ends [m]: where the scene does, beyond the
/// lamp if there is nothing else, or where fog leaves less than a thousandth.
double farthest_slice(const scene::View& view, const scene::Light& light, const scene::Box& box);

/// `froxel`: airlight from a volume of the view frustum, which is lit from the shadow map, summed from the
/// front to the back, and read at each pixel's surface. No history: each frame stands for itself.
/// Based on: Wronski, "Volumetric Fog", SIGGRAPH 2014; Hillaire, "Physically Based and Unified Volumetric
/// Rendering in Frostbite", SIGGRAPH 2015 (both in the course Advances in Real-Time Rendering). What
/// deviates: shaders/media/froxel_ray.glsl, froxel_scatter.comp.
class Froxel : public frame::Airlight {
 public:
  explicit Froxel(const FroxelOptions& options);

  /// The options must not refuse the view.
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override;
  /// "look_ups" of the shadow map.
  std::map<std::string, double> counters(const frame::FrameInputs& inputs) override;
  std::map<std::string, std::int64_t> bytes() const override { return {{"froxels", froxels_.bytes()}}; }

 private:
  /// What the shaders are specialised for.
  struct Variant {
    std::uint32_t phase, layer, reach;
    bool light_textured, plane, sun;
    auto operator<=>(const Variant&) const = default;
  };
  struct Programs {
    gpu::Pipeline scatter, sum;
    frame::ScreenPass read;
  };
  const Programs& load(const Variant& variant);

  FroxelOptions options_;
  gpu::Buffer space_;  ///< EpipolarBlock
  gpu::Texture froxels_;
  std::map<Variant, Programs> programs_;
};

frame::AirlightMethod froxel_method();

}  // namespace airlight::media
