#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "frame/scene_buffers.h"
#include "frame/screen_pass.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

/// What positions are relative to in single precision: where a point light is, under a sun the eye. World
/// space [m]: rounded to float, and what the rounding left.
struct LightOrigin {
  glm::vec3 high, low;
};
LightOrigin light_origin(const scene::Light& light, glm::dvec3 eye);

/// The points that a frame shades, read back; row 0 at the top.
struct SurfacePoints {
  std::vector<std::uint32_t> triangles;  ///< in scene::Geometry::triangles, + 1; 0 where no surface is seen

  /// For each light, of each pixel: the point's position relative to the light, of a sun to the eye, world
  /// axes [m]; w is 1, 0 where the surface's plane parts eye and light, −1 where no surface is seen.
  std::vector<std::vector<glm::vec4>> of_light;
};

/// Finds for each pixel the point of the triangle seen there that is asked for shadows, and whether its
/// surface faces the light: shaders/frame/surface_points.frag.
class SurfacePointPass {
 public:
  SurfacePointPass();

  /// The blocks of camera and light are bound.
  /// @param triangles as of GBuffer; @param points rgba32f, of its size
  void run(const SceneBuffers& scene, const gpu::Texture& triangles, const LightOrigin& origin,
           const gpu::Texture& points) const;

 private:
  ScreenPass pass_;
};

}  // namespace airlight::frame
