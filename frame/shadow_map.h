#pragma once

#include <bitset>

#include "frame/scene_buffers.h"
#include "frame/surface_pipeline.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::frame {

/// @throws scene::Error (driver) when the driver has no texture of that size.
void require_shadow_map(const gpu::Context& context, int size);

/// Draws depth on a face of a cube, the uniform at location 0, or on a plane (shadow_plane.h).
SurfacePipeline make_shadow_map_pipeline(bool is_plane);

/// Of the shadow map's cube, by their numbers (shaders/frame/shadow_cube.glsl).
using CubeFaces = std::bitset<6>;

/// The faces on which directions from the light to what a camera may see fall, surfaces and the air before
/// them, and directions beside those.
/// @param light world space
/// @param reach how far beside those [rad]; π and more: all faces
CubeFaces needed_faces(const scene::CameraFrame& camera, glm::dvec3 light, double reach);

/// The shadow map of a light that is near: the distance to the nearest surface in every direction, a cube of
/// six depth images.
///
/// A texel holds light_near / z for the nearest surface at z along its face's axis, 0 where there is none and
/// on faces that are not drawn.
class ShadowMap {
 public:
  /// @param size side of a face [texels]
  /// @throws scene::Error (driver) when the driver has no texture of that size.
  ShadowMap(const gpu::Context& context, int size);

  /// No face counts as drawn any more: the light is another, or all is to be drawn anew.
  void reset() { drawn_.reset(); }

  /// Whether all of `faces` are drawn.
  bool has(CubeFaces faces) const { return (faces & ~drawn_).none(); }

  /// Draws the scene as seen from `light`, world space, on those of `faces` that are not drawn yet. The
  /// light's block is bound, of which only LightBlock::near matters.
  /// @param left_out triangle numbers, sorted
  void draw(const SceneBuffers& scene, glm::dvec3 light, std::span<const std::uint32_t> left_out,
            CubeFaces faces);

  /// sampler2DArray; see shaders/frame/shadow_cube.glsl.
  const gpu::Texture& depth() const { return depth_; }

 private:
  gpu::Texture depth_;
  std::vector<gpu::Framebuffer> faces_;
  CubeFaces drawn_;
  CubeFaces empty_;  ///< known to hold nothing but 0
  SurfacePipeline pipeline_;
};

}  // namespace airlight::frame
