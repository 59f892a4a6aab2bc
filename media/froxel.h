#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <vector>

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
  int samples = 1;       ///< look-ups a froxel
  bool history = false;  ///< along a path, what is lit is blended with what the frame before found

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
/// front to the back, and read at each pixel's surface.
///
/// With a history what is lit is blended with what the frame before found. It begins anew in a frame that
/// draws all of its own (frame::Resting::redrawn), the first of a path or one that stands alone, and for
/// another scene, light or number of froxels: such a frame is the same as without, and a path the same
/// whenever it is played. A light or an occluder that moves leaves ghosts.
///
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
  std::map<std::string, std::int64_t> bytes() const override;

 private:
  /// What a light's next frame is told of this one.
  struct History {
    gpu::Texture lit;  ///< r32f: what part of each froxel is lit
    shaders::FroxelHistoryBlock seen{};
    int frames = 0;  ///< since it began
    std::uint64_t scene = 0;
    std::string light;  ///< its name
    bool is_sun = false;
  };
  /// Binds what a light's frame asks of the one before, and writes what the next one will ask.
  void begin_history(const frame::FrameInputs& inputs, glm::ivec3 count, float farthest);

  /// What the shaders are specialised for.
  struct Variant {
    std::uint32_t phase, layer, reach;
    bool light_textured, plane, sun, history;
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
  gpu::Buffer history_block_;       ///< FroxelHistoryBlock
  std::vector<History> histories_;  ///< one a light
  gpu::Texture lit_;  ///< what this frame finds; of the size of each history's, with which it changes places
  std::map<Variant, Programs> programs_;
};

frame::AirlightMethod froxel_method();

}  // namespace airlight::media
