#pragma once

#include "frame/scene_buffers.h"
#include "frame/screen_pass.h"
#include "frame/surface_pipeline.h"
#include "gpu/texture.h"

namespace airlight::frame {

/// What each view ray hits first: the triangle, its normal and distance. The material follows from the
/// triangle.
class GBuffer {
 public:
  explicit GBuffer(glm::ivec2 size);

  /// Draws the scene. The camera's block is bound.
  /// @param left_out triangle numbers, sorted
  void draw(const SceneBuffers& scene, const scene::CameraFrame& camera,
            std::span<const std::uint32_t> left_out);

  /// As `surfaces`, of the camera whose block is bound: the same one, in as many or in fewer pixels.
  void find_surfaces(const SceneBuffers& scene, const gpu::Texture& surfaces) const;

  const gpu::Texture& triangles() const { return triangles_; }  ///< r32ui: number + 1, 0 for none

  /// rgba32f: unit normal towards the eye, world axes; distance along the unit view ray [m]. All 0 for none.
  const gpu::Texture& surfaces() const { return surfaces_; }

 private:
  gpu::Texture triangles_, surfaces_, depth_;
  gpu::Framebuffer framebuffer_;
  SurfacePipeline draw_;
  ScreenPass resolve_;
};

}  // namespace airlight::frame
