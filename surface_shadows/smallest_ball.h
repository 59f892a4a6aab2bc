#pragma once

#include <span>

#include <glm/glm.hpp>

namespace airlight::surface_shadows {

/// All points no farther than `radius` from `centre`; in the plane a disc.
template <int Dimensions>
struct Ball {
  glm::vec<Dimensions, double> centre;
  double radius;
};

/// The smallest ball around some points, at least one: its radius to 1e-9 of itself.
/// Based on: Welzl, "Smallest enclosing disks (balls and ellipsoids)", 1991, with the move-to-front heuristic
/// of section 5. The ball through the points of a boundary is the solution of least norm, after Gärtner,
/// "Fast and robust smallest enclosing balls", 1999, so that points that coincide or lie in line do no harm.
Ball<3> smallest_ball(std::span<const glm::dvec3> points);
Ball<2> smallest_ball(std::span<const glm::dvec2> points);

}  // namespace airlight::surface_shadows
