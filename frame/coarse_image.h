#pragma once

#include <cstdint>

#include "frame/gbuffer.h"
#include "frame/scene_buffers.h"
#include "frame/screen_pass.h"
#include "frame/view_rays.h"
#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

/// An image of fewer pixels in which airlight is computed, and from which each pixel takes that of its four
/// neighbours whose surfaces are about as far as its own.
///
/// Airlight is smooth but at shadows' edges and where surfaces end: there the pixel takes from whoever sees
/// its surface, and is wrong where none of the four does.
/// Based on: Kopf, Cohen, Lischinski, Uyttendaele, "Joint Bilateral Upsampling", SIGGRAPH 2007, with depth as
/// the guide, as engines do it.
class CoarseImage {
 public:
  /// @param where `half` or `quarter`
  explicit CoarseImage(Where where);

  /// The view of the last `begin` in fewer pixels. Its image may reach a part of a pixel farther to the
  /// sides.
  const scene::View& view() const { return view_; }
  const gpu::Texture& surfaces() const { return surfaces_; }
  const gpu::Texture& airlight() const { return airlight_; }

  /// Finds the surfaces of a view, and binds the block of its camera.
  /// @param near see CameraBlock
  void begin(const scene::View& view, const GBuffer& gbuffer, const SceneBuffers& scene, float near);
  void bind_camera() const;

  /// @param surfaces of all pixels; @param airlight rgba32f, of their size
  void upsample(const gpu::Texture& surfaces, const gpu::Texture& airlight) const;

  std::int64_t bytes() const { return surfaces_.bytes() + airlight_.bytes(); }

 private:
  Where where_;
  scene::View view_;
  gpu::Texture surfaces_, airlight_;
  gpu::Buffer camera_block_;
  ScreenPass upsample_;
};

/// The size of the coarse image.
glm::ivec2 coarse_size(glm::ivec2 size, Where where);

}  // namespace airlight::frame
