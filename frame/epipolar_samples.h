#pragma once

#include <cstdint>

#include "frame/gbuffer.h"
#include "frame/scene_buffers.h"
#include "frame/screen_pass.h"
#include "frame/view_rays.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

/// View rays that are not those of an image's pixels: a list of them, one a texel of its images. Where they
/// pass through the view's image is bound (shaders/frame/ray_place.glsl), and so is how many there are, which
/// the GPU alone knows (shaders/frame/ray_list.glsl).
struct ListedRays {
  const gpu::Texture& surfaces;  ///< rgba32f: what they see, as FrameInputs::surfaces
  std::uint32_t most;            ///< how many there may be
  const gpu::Buffer& list;       ///< shaders::RayListBlock

  /// How many there are. Waits for the GPU.
  std::uint32_t count() const;
};

/// Airlight is computed at samples on epipolar lines, and pixels take from those around them that see as far.
/// Along such a line airlight changes smoothly but where depth breaks: only some samples are asked, those on
/// both sides of breaks among them, and the others interpolated. Pixels that no sample serves are asked
/// themselves. All rays to be asked stand in one list.
/// Based on: Engelhardt and Dachsbacher, "Epipolar Sampling for Shadows and Crepuscular Rays in Participating
/// Media with Single Scattering", I3D 2010; samples added where airlight without shadows bends, and pixels
/// that are asked themselves, after Yusov, "Practical Implementation of Light Scattering Effects Using
/// Epipolar Sampling and 1D Min/Max Binary Trees", GDC 2013. Deviation: about a lamp what is interpolated is
/// airlight times sin α, which has no peak there.
class EpipolarSamples {
 public:
  /// @param rays Where::epipolar
  explicit EpipolarSamples(const ViewRays& rays) : rays_(rays) {}

  /// Makes room for a view.
  /// @throws scene::Error (driver) where the driver has no texture or buffer that large
  void begin(const gpu::Limits& limits, const scene::View& view);

  /// Lists the rays of a light, and binds what methods read of them. The blocks of camera and light are
  /// bound.
  void list_rays(const scene::Light& light, const GBuffer& gbuffer, const SceneBuffers& scene);

  ListedRays listed() const { return {surfaces_, most_, list_}; }
  const gpu::Texture& airlight() const { return ray_airlight_; }  ///< rgba32f, of listed rays

  /// @param surfaces of all pixels; @param airlight rgba32f, of their size
  void upsample(const gpu::Texture& surfaces, const gpu::Texture& airlight) const;

  std::int64_t bytes() const;

 private:
  ViewRays rays_;
  glm::ivec2 size_{0};                             ///< of the view's image
  std::uint32_t most_ = 0;                         ///< rays that may be listed: of all samples and all pixels
  gpu::Texture sample_depths_, sample_airlight_;   ///< a row a slice
  gpu::Texture places_, surfaces_, ray_airlight_;  ///< of listed rays
  gpu::Buffer list_, members_, groups_;            ///< shaders/frame/ray_list_block.glsl, list_rays.glsl
  gpu::TexelView member_texels_, group_texels_;

  struct Programs {
    Programs();
    ScreenPass sample_depths, surfaces, sample_airlight, upsample;
    gpu::Pipeline list_samples, list_pixels;
  };
  Programs programs_;
};

}  // namespace airlight::frame
