#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "frame/scene_buffers.h"
#include "frame/surface_pipeline.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

/// Where the shadow map of a light lies that is drawn on a plane (shaders/frame/shadow_plane.glsl), and what
/// of the scene belongs on it: what can shade what is seen. That is the image's pyramid swept towards the
/// light, and then cut by the scene's box; cut first, it would lose the shadows of fog outside the box.
struct ShadowPlane {
  glm::dvec4 image_x, image_y;          ///< see LightBlock, as …
  double depth_scale, depth_offset;     ///< … are these
  double half_texel;                    ///< half the larger side of a texel [m]
  std::vector<glm::dvec3> half_spaces;  ///< inward normals of planes through the eye: the swept pyramid
  glm::dvec3 eye;                       ///< world space [m]
  bool operator==(const ShadowPlane&) const = default;

  /// Whether a box, world space, may reach into the swept pyramid: never wrongly "no".
  bool may_touch(const scene::Box& box) const;
};

/// The shadow map on that plane: one depth image.
class ShadowPlaneMap {
 public:
  /// @param size side [texels]
  /// @throws scene::Error (driver) when the driver has no texture of that size.
  ShadowPlaneMap(const gpu::Context& context, int size);

  /// Draws what of the scene belongs on the plane. The blocks of camera and light are bound.
  void draw(const SceneBuffers& scene, const ShadowPlane& plane);

  /// sampler2DArray of one layer; see shaders/frame/shadow_plane.glsl.
  const gpu::Texture& depth() const { return depth_; }

 private:
  gpu::Texture depth_;
  gpu::Framebuffer target_;
  SurfacePipeline pipeline_;
};

/// @param box  of the scene
/// @param size of the map [texels]
/// @returns none for a light too near for a plane, which needs a cube
std::optional<ShadowPlane> fit_shadow_plane(const scene::Light& light, const scene::CameraFrame& camera,
                                            const scene::Box& box, int size);

}  // namespace airlight::frame
