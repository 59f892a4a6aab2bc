#include "reference/light_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace airlight::reference {

namespace {

/// Below this sine, the direction across l is rounding noise.
constexpr double k_parallel = 1e-12;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

}  // namespace

LightPlane make_light_plane(const glm::dvec3& l, const glm::dvec3& direction, const glm::dvec3& right,
                            double smallest_alpha) {
  LightPlane plane;
  plane.w = direction;
  plane.sin_alpha = glm::length(glm::cross(l, direction));
  plane.cos_alpha = glm::dot(l, direction);
  const glm::dvec3 across = plane.sin_alpha > k_parallel ? direction : right;
  const glm::dvec3 m = glm::normalize(across - glm::dot(across, l) * l);

  const double alpha = std::atan2(plane.sin_alpha, plane.cos_alpha);
  const double largest_alpha = std::numbers::pi - k_smallest_psi_eye;
  if (alpha < smallest_alpha || alpha > largest_alpha) {
    const double moved = std::min(std::max(alpha, smallest_alpha), largest_alpha);
    plane.sin_alpha = std::sin(moved);
    plane.cos_alpha = std::cos(moved);
    plane.w = plane.cos_alpha * l + plane.sin_alpha * m;
  }
  plane.q = plane.cos_alpha * m - plane.sin_alpha * l;
  return plane;
}

Stretch in_medium(std::optional<double> eye_y, double w_y, double distance) {
  const double end = distance > 0.0 ? distance : k_infinity;
  if (!eye_y) return {0.0, end};
  const double at_top = -*eye_y / w_y;  // where the ray passes the layer's top
  if (*eye_y <= 0.0) return {0.0, w_y > 0.0 ? std::min(at_top, end) : end};
  if (w_y >= 0.0 || at_top >= end) return {0.0, 0.0};
  return {at_top, end};
}

glm::dvec3 far_end(const glm::dvec3& eye, const glm::dvec3& w) {
  glm::dvec3 end;
  for (int axis = 0; axis < 3; ++axis)
    end[axis] = w[axis] == 0.0 ? eye[axis] : std::copysign(k_infinity, w[axis]);
  return end;
}

}  // namespace airlight::reference
