#pragma once

#include "frame/scene_buffers.h"
#include "gpu/program.h"
#include "gpu/texture.h"

namespace airlight::frame {

/// What each view ray hits first: the triangle and its distance. Normal and material follow from the triangle.
class GBuffer {
 public:
  explicit GBuffer(glm::ivec2 size);

  /// Draws the scene. The view's uniform block is bound.
  void draw(const SceneBuffers& scene, const scene::CameraFrame& camera) const;

  const gpu::Texture& triangles() const { return triangles_; }  ///< r32ui: number + 1, 0 for none
  const gpu::Texture& distance() const { return distance_; }    ///< r32f: along the unit view ray [m], 0 for none

 private:
  gpu::Texture triangles_, distance_, depth_;
  gpu::Framebuffer framebuffer_;
  gpu::Program draw_, surface_distance_;
};

}  // namespace airlight::frame
