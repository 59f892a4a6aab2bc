#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "frame/coarse_image.h"
#include "frame/epipolar_samples.h"
#include "frame/gbuffer.h"
#include "frame/methods.h"
#include "frame/resources.h"
#include "frame/screen_pass.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace airlight::frame {

/// A finished frame, read back; row 0 at the top, nothing clamped.
struct FrameImages {
  glm::ivec2 size{0};
  std::vector<glm::vec3> radiance;  ///< all that is seen [W/(m² sr)]
  std::vector<glm::vec3> airlight;  ///< airlight alone [W/(m² sr)]

  std::vector<std::string> lights;  ///< the name of each
  std::vector<bool> is_skipped;  ///< for each light, whether it was left out because it cannot reach the view
  std::vector<std::vector<glm::vec3>> airlight_of_light;  ///< for each light, where there are several

  /// For each light the part of it that arrives at each surface: 1 where it sees the light, 0 in shadow and
  /// where no surface is seen; the mean over RGB where occluders let colours through. 0 of a light that was
  /// skipped.
  std::vector<std::vector<float>> visibility;
  /// Where occluders let colours through, of each light the same by channels; else empty.
  std::vector<std::vector<glm::vec3>> transmittance;
  std::vector<float> distance;  ///< along the view ray [m], 0 where no surface is seen
};

/// Renders frames of one scene:
/// G-buffer → for each light: shadow map → surface shadow → airlight → composite.
class Frame {
 public:
  /// @param geometry kept by reference: it must outlive the frame
  /// @param shadow_map_size side of a cube face [texels]; used only by methods that ask for a shadow map
  /// @param scene, long_work see Resources
  Frame(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size,
        std::shared_ptr<const SceneBuffers> scene = {}, LongWork long_work = {});

  /// Issues all work of one frame to the GPU, without waiting for it where `timer` is off. Of the timer's
  /// parts number i is that of light i. A light that cannot reach the view is skipped, unless a method sees
  /// every one.
  /// @param resting whether a shadow map, or a method's volume, that is as it was in the last frame is made
  /// anew
  /// @throws scene::Error (bad_file) where scene::validate does; (driver) for an image over the driver's
  /// limit.
  void render(const scene::View& view, SurfaceShadow& surface_shadow, Airlight& airlight,
              gpu::StageTimer& timer, Resting resting = Resting::redrawn);

  /// What the last frame made for its lights: of "shadow_map", any face of it, and "volume".
  const std::set<std::string>& redrawn() const { return resources_.redrawn(); }

  // Of the last frame, on the GPU, rgba32f; row 0 at the top:
  const gpu::Texture& radiance() const { return radiance_; }  ///< as FrameImages::radiance
  const gpu::Texture& airlight() const { return airlight_; }  ///< as FrameImages::airlight

  /// Waits for the last frame.
  /// @throws scene::Error (driver) when it holds NaN or infinity: never shown as a colour.
  FrameImages read() const;

  /// As `read`, and frees each image once it is read: large ones are never held twice.
  FrameImages take();

  /// GPU memory of what the last frame used beside its methods' own, by name.
  std::map<std::string, std::int64_t> bytes() const;

 private:
  void require_images(const scene::View& view, gpu::Format visibility_format);
  void composite(std::size_t light, bool adds);
  void add_surroundings(const scene::Surroundings& surroundings);
  /// The airlight of one light: of a light alone, all there is.
  const gpu::Texture& airlight_of(std::size_t light) const {
    return airlight_of_light_.empty() ? airlight_ : airlight_of_light_[light];
  }

  gpu::Context& context_;
  Resources resources_;
  gpu::Buffer camera_block_, light_block_, medium_block_;
  /// By: the light is textured, it adds to others, surfaces glow with what they let through.
  std::map<std::array<bool, 3>, std::optional<ScreenPass>> composite_;
  std::optional<ScreenPass> surroundings_;
  LookImages look_images_;  ///< where the scene has looks

  std::optional<GBuffer> gbuffer_;
  std::map<Where, CoarseImage> coarse_images_;  ///< each stays, with its program, when methods take turns
  std::map<ViewRays, EpipolarSamples> epipolar_samples_;  ///< the same
  CoarseImage* coarse_image_ = nullptr;                   ///< that of the last frame, if any
  EpipolarSamples* samples_ = nullptr;                    ///< the same
  std::vector<std::string> lights_;
  std::vector<bool> is_skipped_;
  std::vector<gpu::Texture> visibility_;         ///< one a light
  gpu::Texture airlight_;                        ///< of all lights
  std::vector<gpu::Texture> airlight_of_light_;  ///< one a light, where there are several
  gpu::Texture radiance_;
};

}  // namespace airlight::frame
