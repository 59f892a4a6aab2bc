#pragma once

#include <map>
#include <string_view>

#include "scene/builtin.h"
#include "scene/scene.h"

namespace airlight::tests {

/// A built-in scene, made once a program.
inline const scene::Scene& builtin(std::string_view name) {
  static std::map<std::string_view, scene::Scene> scenes;
  const scene::BuiltinScene& builtin = *scene::find_builtin(name);
  const auto kept = scenes.find(builtin.name);
  return kept != scenes.end() ? kept->second : scenes.emplace(builtin.name, builtin.make()).first->second;
}

/// The view that a scene brings along.
inline scene::View view_of(const scene::Scene& scene, glm::ivec2 size) {
  return {
      .camera = scene.cameras.at(0), .lights = {scene.lights.at(0)}, .medium = scene.medium, .size = size};
}

/// Adds the triangle (a, b, c).
inline void add_triangle(scene::Geometry& geometry, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  if (geometry.materials.empty()) geometry.materials.emplace_back();
  const auto first = static_cast<std::uint32_t>(geometry.positions.size());
  geometry.positions.insert(geometry.positions.end(), {a, b, c});
  geometry.triangles.emplace_back(first, first + 1, first + 2);
  geometry.material_of_triangle.push_back(0);
}

/// Adds the parallelogram corner, corner + u, corner + u + v, corner + v.
inline void add_quad(scene::Geometry& geometry, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  add_triangle(geometry, corner, corner + u, corner + u + v);
  add_triangle(geometry, corner, corner + u + v, corner + v);
}

/// A square in the plane y = 0 about the origin.
inline scene::Geometry level_plane(float half_side) {
  scene::Geometry plane;
  add_quad(plane, {-half_side, 0, -half_side}, {2 * half_side, 0, 0}, {0, 0, 2 * half_side});
  return plane;
}

/// From above, at the origin, by a light.
inline scene::View view_of_level_plane(glm::dvec3 light) {
  scene::View view;
  view.camera.eye = {0, 4, 8};
  view.camera.target = {0, 0, 0};
  view.lights[0].position = light;
  view.size = {64, 64};
  return view;
}

/// From within the box from −1 to 1, of fog.
inline scene::View view_in_a_room() {
  scene::View view;
  view.camera.eye = {0.2, 0.1, 0.9};
  view.camera.target = {0, 0, -1};
  view.camera.vertical_fov_degrees = 90;
  view.medium.sigma_s = glm::vec3(0.3f);
  view.size = {48, 48};
  return view;
}

/// Of the scene `empty`, in fog that scatters and absorbs each channel otherwise.
inline scene::View view_of_coloured_fog(glm::ivec2 size) {
  scene::View view = view_of(builtin("empty"), size);
  view.medium.sigma_s = {0.1f, 0.3f, 0.05f};
  view.medium.sigma_a = {0.02f, 0.0f, 0.4f};
  view.medium.rayleigh_weight = 0.3f;
  return view;
}

/// Adds the faces of a box.
inline void add_box(scene::Geometry& geometry, glm::vec3 lower, glm::vec3 upper) {
  const glm::vec3 size = upper - lower;
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_quad(geometry, lower, y, x);
  add_quad(geometry, lower, z, y);
  add_quad(geometry, lower, x, z);
  add_quad(geometry, lower + z, x, y);
  add_quad(geometry, lower + x, y, z);
  add_quad(geometry, lower + y, z, x);
}

}  // namespace airlight::tests
