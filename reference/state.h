#pragma once

#include <optional>

#include "reference/light_texture.h"
#include "reference/reference.h"
#include "reference/triangles.h"
#include "reference/view_ray.h"
#include "reference/visibility.h"
#include "scene/scene.h"

namespace airlight::reference {

/// What `Reference` keeps: the view, and the triangles around its light.
struct Reference::State {
  scene::View view;
  scene::Light light;
  scene::CameraFrame camera;
  Triangles triangles;
  Visibility visibility;                     ///< of `triangles`
  glm::dvec3 eye;                            ///< relative to the light [m]
  double quarter_pixel;                      ///< the smallest α [rad]
  std::optional<LightLookup> light_texture;  ///< where the light has one

  State(const scene::Geometry& geometry, const scene::View& view, std::size_t light_index);

  /// Unit direction through a point of the image [pixels]; centres are at half-integers.
  glm::dvec3 direction(const glm::dvec2& point) const;
  glm::dvec3 pixel_direction(int x, int y) const { return direction(glm::dvec2(x, y) + 0.5); }

  /// The view ray of a pixel, up to its first surface.
  ViewRay view_ray(int x, int y) const;

  /// σ_s I / (D sin α): what the integral over φ is multiplied with, RGB. A light's texture belongs under the
  /// integral.
  glm::dvec3 airlight_scale(const ViewRay& ray) const;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(view.size.x) + static_cast<std::size_t>(x);
  }
  std::size_t pixels() const { return index(0, view.size.y); }
};

}  // namespace airlight::reference
