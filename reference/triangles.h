#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "reference/cut_outs.h"
#include "scene/scene.h"
#include "scene/transmission.h"

namespace airlight::reference {

/// The corners of a triangle relative to some point [m].
using Corners = std::array<glm::dvec3, 3>;

/// As long as twice the area, by the order of the corners [m²].
inline glm::dvec3 normal(const Corners& c) {
  return glm::cross(c[1] - c[0], c[2] - c[0]);
}

/// Whether the plane of a triangle holds the origin, to the rounding of the corners: seen from there, the
/// triangle is edge-on; it covers nothing and hides nothing.
///
/// Corners are differences that were rounded once, so that the volume below is uncertain by a few times
/// 2⁻⁵³ · (distance of the farthest corner)² · (longest edge).
inline bool is_edge_on(const Corners& c) {
  const glm::dvec3 ab = c[1] - c[0], ac = c[2] - c[0];
  const double volume = glm::dot(c[0], glm::cross(ab, ac));
  const double distance2 = std::max({glm::dot(c[0], c[0]), glm::dot(c[1], c[1]), glm::dot(c[2], c[2])});
  const double edge2 = std::max(glm::dot(ab, ab), glm::dot(ac, ac));
  return std::abs(volume) <= 1e-15 * distance2 * std::sqrt(edge2);
}

/// The same of a sun in that unit direction: whether a triangle lies along its light, to rounding.
inline bool is_edge_on_to_sun(const Corners& c, const glm::dvec3& sun) {
  const glm::dvec3 ab = c[1] - c[0], ac = c[2] - c[0];
  const double distance2 = std::max({glm::dot(c[0], c[0]), glm::dot(c[1], c[1]), glm::dot(c[2], c[2])});
  const double edge2 = std::max(glm::dot(ab, ab), glm::dot(ac, ac));
  return std::abs(glm::dot(sun, glm::cross(ab, ac))) <= 1e-15 * std::sqrt(distance2 * edge2);
}

/// The surfaces of a scene, before any rounding.
struct Triangles {
  std::vector<glm::vec3> positions;  ///< world space [m]
  std::vector<glm::uvec3> indices;
  CutOuts cut_outs = {};
  /// One a triangle, where light passes any; else empty.
  std::vector<scene::Attenuation> attenuations = {};

  /// Whether light passes that triangle.
  bool transmits(std::uint32_t triangle) const {
    return !attenuations.empty() && !attenuations[triangle].is_opaque();
  }

  std::size_t count() const { return indices.size(); }

  explicit Triangles(const scene::Geometry& geometry)
      : positions(geometry.positions),
        indices(geometry.triangles),
        cut_outs(geometry),
        attenuations(scene::attenuations_of(geometry)) {}
  Triangles() = default;

  /// @param origin world space [m]
  Corners around(const glm::dvec3& origin, std::uint32_t triangle) const {
    const glm::uvec3& corner = indices[triangle];
    return {glm::dvec3(positions[corner.x]) - origin, glm::dvec3(positions[corner.y]) - origin,
            glm::dvec3(positions[corner.z]) - origin};
  }

  /// One flag a triangle: whether it is seen edge-on from there, and may hold the very point. Empty where
  /// none does.
  std::vector<bool> holding(const glm::dvec3& point) const {
    std::vector<bool> flags;
    for (std::uint32_t i = 0; i < count(); ++i) {
      const Corners c = around(point, i);
      const glm::dvec3 lower = glm::min(glm::min(c[0], c[1]), c[2]),
                       upper = glm::max(glm::max(c[0], c[1]), c[2]);
      const double slack = 1e-6 * glm::length(upper - lower);  // what Embree widens a triangle by, and more
      if (glm::any(glm::greaterThan(lower, glm::dvec3(slack))) ||
          glm::any(glm::lessThan(upper, glm::dvec3(-slack))))
        continue;
      if (!is_edge_on(c)) continue;
      flags.resize(count());
      flags[i] = true;
    }
    return flags;
  }

  /// One flag a triangle: whether it lies along a sun's light. Empty where none does.
  /// @param origin from where corners are known, world space [m]
  std::vector<bool> along(const glm::dvec3& sun, const glm::dvec3& origin) const {
    std::vector<bool> flags;
    for (std::uint32_t i = 0; i < count(); ++i) {
      if (!is_edge_on_to_sun(around(origin, i), sun)) continue;
      flags.resize(count());
      flags[i] = true;
    }
    return flags;
  }
};

}  // namespace airlight::reference
