#include "reference/view_ray.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

// With the light at the origin and l the unit direction from the eye to the light, the eye is −D l and the
// points of the view ray are P(t) = −D l + t w. The part of −D l across w is −D (l − w cos α) = D sin α q
// with q = m cos α − l sin α, m being the unit vector across l in the plane of w: w = l cos α + m sin α. The
// triangle of eye, light and P has the angles α, φ and ψ = π − α − φ; the law of sines gives (2). P's place
// along w, from the foot of the perpendicular, is r cos ψ, which gives (1). For (3), D cos((α−φ)/2) /
// cos((α+φ)/2) with φ = π − α − ψ is D sin(α + ψ/2) / sin(ψ/2).

namespace airlight::reference {

namespace {

/// Below this sine, the direction across l is rounding noise.
constexpr double k_parallel = 1e-12;

}  // namespace

glm::dvec3 ViewRay::end(const glm::dvec3& eye) const {
  if (psi_end > 0.0) return D * sin_alpha * (q + w / std::tan(psi_end));
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 end;
  for (int axis = 0; axis < 3; ++axis)
    end[axis] = w[axis] == 0.0 ? eye[axis] : std::copysign(k_infinity, w[axis]);
  return end;
}

ViewRay make_view_ray(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& right,
                      double distance, double smallest_alpha) {
  ViewRay ray;
  ray.D = glm::length(eye);
  assert(ray.D > 0.0);
  const glm::dvec3 l = -eye / ray.D;

  ray.w = direction;
  ray.sin_alpha = glm::length(glm::cross(l, direction));
  ray.cos_alpha = glm::dot(l, direction);
  const glm::dvec3 across = ray.sin_alpha > k_parallel ? direction : right;
  const glm::dvec3 m = glm::normalize(across - glm::dot(across, l) * l);

  const double alpha = std::atan2(ray.sin_alpha, ray.cos_alpha);
  const double largest_alpha = std::numbers::pi - k_smallest_psi_eye;
  if (alpha < smallest_alpha || alpha > largest_alpha) {
    const double moved = std::min(std::max(alpha, smallest_alpha), largest_alpha);
    ray.sin_alpha = std::sin(moved);
    ray.cos_alpha = std::cos(moved);
    ray.w = ray.cos_alpha * l + ray.sin_alpha * m;
  }
  ray.q = ray.cos_alpha * m - ray.sin_alpha * l;

  // Each angle from its own sides: as a difference it would lose its digits where it is small.
  ray.psi_eye = std::atan2(ray.sin_alpha, -ray.cos_alpha);
  if (distance > 0.0) {
    ray.psi_end = std::atan2(ray.D * ray.sin_alpha, distance - ray.D * ray.cos_alpha);
    ray.phi_d = std::atan2(distance * ray.sin_alpha, ray.D - distance * ray.cos_alpha);
  } else {
    ray.psi_end = 0.0;
    ray.phi_d = ray.psi_eye;
  }
  return ray;
}

}  // namespace airlight::reference
