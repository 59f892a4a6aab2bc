#pragma once

#include "support/scenes.h"

/// Boxes before the walls of an open room, by any light: for what must not depend on how shadow is stored.
namespace airlight::tests {

/// @param has_plates just before the eye, and one behind it
inline scene::Geometry open_room(bool has_plates = false) {
  scene::Geometry geometry;
  add_quad(geometry, {-3, -1, -3}, {6, 0, 0}, {0, 0, 6});
  add_quad(geometry, {-3, -1, -3}, {0, 4, 0}, {6, 0, 0});
  for (int i = 0; i < 9; ++i) {
    const glm::vec3 at(static_cast<float>(i % 3) - 1.2f, 0.4f * static_cast<float>(i / 3) - 0.8f,
                       -0.7f * static_cast<float>(i % 4));
    add_box(geometry, at, at + glm::vec3(0.3f, 0.17f, 0.25f));
  }
  if (has_plates) {
    add_quad(geometry, {0.1f, 0.1f, 2.999f}, {1, 0, 0.1f}, {0, 0.2f, 0});
    add_quad(geometry, {0, 0.2f, 3.2f}, {0.3f, 0, 0}, {0, 0.3f, 0});
  }
  return geometry;
}

inline scene::View open_room_lit_by(const scene::Light& light) {
  scene::View view;
  view.camera.eye = {0.1, 0.2, 3};
  view.camera.target = {0, 0, 0};
  view.camera.vertical_fov_degrees = 70;
  view.medium.sigma_s = {0.1f, 0.2f, 0.3f};
  view.lights = {light};
  view.size = {65, 47};
  return view;
}

inline scene::View open_room_with_lamp_at(glm::dvec3 position) {
  return open_room_lit_by(scene::point_light("", position, glm::vec3(10)));
}

}  // namespace airlight::tests
