#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/triangles.h"

namespace airlight::reference {

/// An axis-aligned box [m], endless where it is infinite.
struct Bounds {
  glm::dvec3 lower, upper;
};

/// The points p with dot(`inward`, p − origin) ≥ 0.
struct HalfSpace {
  glm::dvec3 inward;
  glm::dvec3 origin;
};

/// A convex region: a box, cut by half-spaces.
struct Region {
  static constexpr int k_most = 8;
  Bounds box;
  HalfSpace half_spaces[k_most];
  int count = 0;

  void cut(const HalfSpace& by) { half_spaces[count++] = by; }
};

/// A bounding volume hierarchy over triangles, built by Embree, in the axes of the world around an origin.
class Hierarchy {
 public:
  /// @param triangles kept by reference
  /// @param origin    world space [m]
  /// @throws scene::Error (driver) when Embree fails
  Hierarchy(const Triangles& triangles, const glm::dvec3& origin);
  ~Hierarchy();
  Hierarchy(Hierarchy&&) noexcept;
  Hierarchy& operator=(Hierarchy&&) noexcept;

  /// Writes the numbers of the triangles that may reach into the region: all that do, and some that do not.
  /// @param region relative to the origin
  void find(const Region& region, std::vector<std::uint32_t>& found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace airlight::reference
