#pragma once

#include <optional>

#include "reference/light_texture.h"
#include "reference/reference.h"
#include "reference/run_integrals.h"
#include "reference/sun_ray.h"
#include "reference/triangles.h"
#include "reference/view_ray.h"
#include "reference/visibility.h"
#include "scene/scene.h"

namespace airlight::reference {

/// What `Reference` keeps: the view, and the triangles around its light, or around the eye under a sun.
struct Reference::State {
  scene::View view;
  scene::Light light;
  scene::CameraFrame camera;
  Triangles triangles;
  scene::Box box;                 ///< of the triangles, world space [m]
  std::optional<glm::dvec3> sun;  ///< unit direction to the light where that is a sun
  glm::dvec3 origin;              ///< the light, or the eye under a sun, world space [m]
  glm::dvec3 eye;                 ///< relative to the origin [m]
  std::optional<double> top;      ///< of the medium, height over the origin [m]
  Visibility visibility;          ///< of `triangles`
  /// The same around the eye, where the light is so far that single precision around it loses the scene.
  std::optional<Visibility> around_eye;
  double quarter_pixel = 0.0;                ///< the smallest α [rad]
  std::optional<LightLookup> light_texture;  ///< where the light has one

  State(const scene::Geometry& geometry, const scene::View& view, std::size_t light_index);
  void resize(glm::ivec2 image_size);

  /// Unit direction through a point of the image [pixels]; centres are at half-integers.
  glm::dvec3 direction(const glm::dvec2& point) const;
  glm::dvec3 pixel_direction(int x, int y) const { return direction(glm::dvec2(x, y) + 0.5); }

  /// The view ray of a pixel, up to its first surface: a `ViewRay` of a point light, a `SunRay` of a sun.
  template <class Ray>
  Ray ray(int x, int y) const;

  /// Knows the first surfaces.
  const Visibility& seen() const { return around_eye ? *around_eye : visibility; }

  RunIntegrals run_integrals(int refinement = 1) const {
    return {light, view.medium, light_texture ? &*light_texture : nullptr, refinement};
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(view.size.x) + static_cast<std::size_t>(x);
  }
  std::size_t pixels() const { return index(0, view.size.y); }
};

template <>
ViewRay Reference::State::ray<ViewRay>(int x, int y) const;
template <>
SunRay Reference::State::ray<SunRay>(int x, int y) const;

}  // namespace airlight::reference
