#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include "scene/scene.h"

/// What the built-in scenes share, and no one else needs.
namespace airlight::scene {

/// Adds shapes to a geometry. Faces are counter-clockwise seen from outside a solid.
class Modeller {
 public:
  explicit Modeller(Geometry& geometry) : geometry_(geometry) {}

  /// Shapes that follow get this reflectance.
  void paint(glm::vec3 albedo) { geometry_.materials.push_back({albedo}); }

  /// @returns the index of a new vertex
  std::uint32_t vertex(glm::dvec3 position) {
    geometry_.positions.emplace_back(position);
    return static_cast<std::uint32_t>(geometry_.positions.size() - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    geometry_.triangles.emplace_back(a, b, c);
    geometry_.material_of_triangle.push_back(static_cast<std::uint32_t>(geometry_.materials.size() - 1));
  }

  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

  /// A closed box, optionally turned about the vertical through its middle.
  void box(glm::dvec3 lower, glm::dvec3 upper, double turn_degrees = 0.0);

 private:
  Geometry& geometry_;
};

Scene make_window();

}  // namespace airlight::scene
