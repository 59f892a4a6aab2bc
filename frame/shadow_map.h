#pragma once

#include "frame/scene_buffers.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::frame {

/// The distance from the light to the nearest surface in every direction: a cube of six depth images.
///
/// A texel holds light_near / z for the nearest surface at z along its face's axis, 0 where there is none.
class ShadowMap {
 public:
  /// @param size side of a face [texels]
  /// @throws scene::Error (driver) when the driver has no texture of that size.
  ShadowMap(const gpu::Context& context, int size);

  /// Draws the scene as seen from `light`, world space. The blocks of camera and light are bound.
  /// @param left_out triangle numbers, sorted
  void draw(const SceneBuffers& scene, glm::dvec3 light, std::span<const std::uint32_t> left_out) const;

  /// sampler2DArray; see shaders/frame/shadow_cube.glsl.
  const gpu::Texture& depth() const { return depth_; }

 private:
  gpu::Texture depth_;
  std::vector<gpu::Framebuffer> faces_;
  gpu::Pipeline program_;
};

}  // namespace airlight::frame
