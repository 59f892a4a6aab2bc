#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "frame/gbuffer.h"
#include "frame/methods.h"
#include "frame/scene_buffers.h"
#include "frame/shadow_map.h"

namespace airlight::frame {

/// A finished frame, read back; row 0 at the top, nothing clamped.
struct FrameImages {
  glm::ivec2 size{0};
  std::vector<glm::vec3> radiance;  ///< surfaces and airlight [W/(m² sr)]
  std::vector<glm::vec3> airlight;  ///< airlight alone [W/(m² sr)]
  std::vector<float>
      visibility;  ///< 1 where a surface sees the light, 0 in shadow and where no surface is seen
  std::vector<float> distance;  ///< along the view ray [m], 0 where no surface is seen
};

/// Renders frames of one scene:
/// G-buffer → shadow map → surface shadow → airlight → composite.
class Frame {
 public:
  /// @param geometry kept by reference: it must outlive the frame
  /// @param shadow_map_size side of a cube face [texels]; used only by methods that need a shadow map
  Frame(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size);

  /// Issues all work of one frame to the GPU, without waiting for it where `timer` is off.
  /// @throws scene::Error (bad_file) where scene::validate does; (driver) for an image over the driver's
  /// limit.
  void render(const scene::View& view, SurfaceShadow& surface_shadow, Airlight& airlight,
              gpu::StageTimer& timer);

  /// Waits for the last frame.
  /// @throws scene::Error (driver) when it holds NaN or infinity: never shown as a colour.
  FrameImages read() const;

  std::map<std::string, std::int64_t> bytes() const;

 private:
  /// Brings the light's texture to the GPU and makes the compositor fit for it.
  void load_light_texture(const std::shared_ptr<const scene::LightTexture>& texture);

  gpu::Context& context_;
  SceneBuffers scene_;
  int shadow_map_size_;
  std::optional<ShadowMap> shadow_map_;
  gpu::Buffer view_block_;
  gpu::Pipeline composite_;
  std::shared_ptr<const scene::LightTexture> light_texture_;  ///< the one on the GPU
  gpu::Texture light_texture_texels_;
  std::optional<GBuffer> gbuffer_;
  gpu::Texture visibility_, airlight_, radiance_;
};

}  // namespace airlight::frame
