#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/hierarchy.h"
#include "reference/triangles.h"
#include "scene/scene.h"

namespace airlight::reference {

/// What a frame shades in a pixel.
struct SurfacePoint {
  glm::vec3 position;      ///< relative to the light, of a sun relative to the eye [m]; as the frame has it
  std::uint32_t triangle;  ///< on which it lies: its number
};

enum class Verdict : std::uint8_t { dark, lit };

struct SurfaceVerdict {
  Verdict verdict;  ///< dark where nothing of the light arrives
  bool is_decided;  ///< whether the frame's rounding of the point leaves no choice
  /// What arrives of the light, RGB: less than all behind triangles that it passes.
  glm::vec3 share = glm::vec3(verdict == Verdict::lit ? 1.0f : 0.0f);
  bool operator==(const SurfaceVerdict&) const = default;
};

/// Whether points of surfaces, as a frame has them, are hidden from a light by any triangle: without any
/// rounding.
///
/// The triangles are those of the frame: their vertices relative to the light, or to the eye under a sun, in
/// single precision. Light travels from the origin to the point, or under a sun along its direction in single
/// precision. All that is decided about these numbers is decided exactly:
///
/// - A surface whose plane has the eye on the one side and the light on the other is dark.
/// - A triangle, its edges included, hides what the light reaches through it strictly beyond its plane. One
///   that is edge-on to the light hides nothing.
/// - The point's own triangle, and those that lie in the same plane in world space, do not hide it.
///
/// A triangle that light passes takes its part of it instead, where the light's ray crosses it: of those that
/// share an edge or a corner which the ray meets, one of each sheet counts, as if the point were moved a
/// little along x, less along y and least along z. A surface of such a triangle that is seen from the side
/// away from the light glows: what reaches its other side has passed it, too.
///
/// The frame's point is off its surface by rounding. Where 16 points around it, as far off as rounding may
/// have taken it, do not all have its verdict, it is undecided.
class SurfaceJudge {
 public:
  /// @param triangles kept by reference
  /// @param eye       world space [m]
  /// @throws scene::Error (driver) when Embree fails
  SurfaceJudge(const Triangles& triangles, const scene::Light& light, const glm::dvec3& eye);

  /// Can be called from many threads at once.
  SurfaceVerdict judge(const SurfacePoint& point) const;

  /// Of all points, in their order, on every core. Quickest where neighbours in the list are close together.
  std::vector<SurfaceVerdict> judge(std::span<const SurfacePoint> points) const;

  /// Whether no plane separates eye and light: whether the plane of the triangle has both on one side, or
  /// holds one of them.
  bool faces(std::uint32_t triangle) const;

  /// How far rounding may take a frame's point off that triangle [m].
  double rounding_of(std::uint32_t triangle) const;

 private:
  /// A point and those around it.
  static constexpr std::size_t k_points = 17;
  struct Cluster;
  struct Scratch;

  std::array<glm::vec3, 3> corners(std::uint32_t triangle) const;
  bool are_coplanar(std::uint32_t a, std::uint32_t b) const;
  enum class Meets { touched, crossed };
  std::uint32_t met_by(std::uint32_t triangle, Meets meets, const Cluster& cluster, std::uint32_t lit) const;
  glm::uvec3 attenuation(std::uint32_t triangle, const glm::dvec3& point) const;
  Region region_before(const Cluster& cluster) const;
  SurfaceVerdict judge(const SurfacePoint& point, Scratch& scratch) const;

  const Triangles& triangles_;
  std::optional<glm::vec3> along_;   ///< of a sun: where its light goes
  glm::dvec3 eye_;                   ///< relative to the light, or to itself under a sun [m]
  std::vector<glm::vec3> vertices_;  ///< relative to the same [m]
  double largest_ = 0.0;             ///< absolute coordinate of a vertex [m]
  double misplaced_ = 0.0;           ///< most that a coordinate differs from the hierarchy's [m]
  std::array<glm::dvec3, k_points - 1> directions_;  ///< to the points around a point, of unit length
  Hierarchy hierarchy_;                              ///< around the light, or the eye under a sun
};

}  // namespace airlight::reference
