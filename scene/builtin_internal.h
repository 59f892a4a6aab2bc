#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

/// What the built-in scenes share, and no one else needs.
namespace airlight::scene {

/// Random numbers that every library gives alike: the standard fixes the engine, but not what its
/// distributions make of it.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  /// In [a, b), every number alike.
  double between(double a, double b) { return a + (b - a) * static_cast<double>(engine_()) / 4294967296.0; }

 private:
  std::mt19937 engine_;
};

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

  /// A closed sphere of 20·cuts² triangles.
  void sphere(glm::dvec3 centre, double radius, std::uint32_t cuts);

  /// A closed solid of revolution about the vertical through `foot`.
  /// @param profile radius (positive) and height, from the bottom up
  void turned(glm::dvec3 foot, std::span<const glm::dvec2> profile, std::uint32_t sides);

  /// A closed round rod along points that turn by less than a right angle at each.
  /// @param path centre and radius (positive), at least two
  void rod(std::span<const glm::dvec4> path, std::uint32_t sides);

  /// A closed slab whose upper face is uneven.
  /// @param x, z    lines of the grid on it, each rising
  /// @param bottom  height of its level lower face
  /// @param height  of the upper one at (x, z)
  void slab(std::span<const double> x, std::span<const double> z, double bottom,
            const std::function<double(double, double)>& height);

 private:
  /// A closed solid of rings of vertices, one after the other, with fans at its ends.
  /// @param at where a ring's vertex lies
  void tube(std::size_t rings, std::uint32_t sides,
            const std::function<glm::dvec3(std::size_t ring, double angle)>& at);

  Geometry& geometry_;
};

using Path = std::vector<glm::dvec2>;

/// Where a flat shape stands: u to its right, v up, w towards the beholder.
struct Plane {
  glm::dvec3 origin, u, v, w;
  glm::dvec3 at(double x, double y, double z) const { return origin + x * u + y * v + z * w; }
};

/// Points on a circle, both ends included; angles in radians from +u to +v.
void arc(Path& path, glm::dvec2 centre, double radius, double from, double to, int steps);

Path circle(glm::dvec2 centre, double radius, int steps);

/// A closed bar along a path in a plane, chamfered front and back.
void bar(Modeller& model, const Plane& plane, const Path& path, bool closed, double width, double depth);

Scene make_window();
Scene make_nave();
Scene make_fence();
Scene make_forest();
Scene make_harbour();
Scene make_jali();
Scene make_chapel();
Scene make_lighthouse();

/// @param triangles at least 2000
Scene make_spheres(std::size_t triangles);
/// @param triangles at least 1000
Scene make_toroid(std::size_t triangles);

}  // namespace airlight::scene
