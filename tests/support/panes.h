#pragma once

#include "support/cut_outs.h"

/// Panes of glass over a floor, by lamp and sun.
namespace airlight::tests {

/// Gives all triangles of a geometry, but the last `floor` ones, glass of that transmittance.
inline scene::Geometry of_glass(scene::Geometry geometry, glm::vec3 transmittance, std::size_t floor = 2) {
  geometry.materials.push_back({.albedo = glm::vec3(0.1f), .transmittance = transmittance});
  const auto glass = static_cast<std::uint32_t>(geometry.materials.size() - 1);
  for (std::size_t i = 0; i + floor < geometry.triangles.size(); ++i)
    geometry.material_of_triangle[i] = glass;
  return geometry;
}

/// A pane over a floor, made of two triangles, and before it, seen from the light, another.
/// @param count of the panes: 0 to 2
inline scene::Geometry panes_over_floor(int count) {
  scene::Geometry geometry;
  for (int i = 0; i < count; ++i)
    add_quad(geometry, {-1, 1.0f + 0.5f * static_cast<float>(i), -4}, {2, 0, 0}, {0, 0, 2});
  add_quad(geometry, {-8, -1, 2}, {16, 0, 0}, {0, 0, -14});
  return geometry;
}

/// From below the panes, which are out of view, to the floor and the wall of fog behind it.
inline scene::View view_below_panes(glm::ivec2 size, bool by_sun) {
  scene::View view;
  view.camera.eye = {0.1, 0.3, 1.5};
  view.camera.target = {0, -1.4, -3};
  view.camera.vertical_fov_degrees = 40;
  view.lights[0] = by_sun ? scene::sun("", {0.1, 1, -0.05}, glm::vec3(10))
                          : scene::point_light("", {0.2, 3, -3.1}, glm::vec3(20));
  view.medium.sigma_s = glm::vec3(0.1f, 0.15f, 0.2f);
  view.size = size;
  return view;
}

}  // namespace airlight::tests
