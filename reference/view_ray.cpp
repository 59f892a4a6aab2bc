#include "reference/view_ray.h"

#include <algorithm>
#include <cassert>
#include <cmath>

// With the light at the origin and l the unit direction from the eye to the light, the eye is −D l and the
// points of the view ray are P(t) = −D l + t w. The part of −D l across w is −D (l − w cos α) = D sin α q
// with q = m cos α − l sin α, m being the unit vector across l in the plane of w: w = l cos α + m sin α. The
// triangle of eye, light and P has the angles α, φ and ψ = π − α − φ; the law of sines gives (2). P's place
// along w, from the foot of the perpendicular, is r cos ψ, which gives (1). For (3), D cos((α−φ)/2) /
// cos((α+φ)/2) with φ = π − α − ψ is D sin(α + ψ/2) / sin(ψ/2).

namespace airlight::reference {

glm::dvec3 ViewRay::end(const glm::dvec3& eye) const {
  if (psi_end > 0.0) return D * sin_alpha * (q + w / std::tan(psi_end));
  return far_end(eye, w);
}

ViewRay make_view_ray(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& right,
                      double distance, double smallest_alpha, std::optional<double> top) {
  const double D = glm::length(eye);
  assert(D > 0.0);
  const LightPlane plane = make_light_plane(-eye / D, direction, right, smallest_alpha);
  const double light_height = top ? std::max(-*top, 0.0) : 0.0;
  const std::optional<double> eye_y = top ? std::optional(eye.y - *top) : std::nullopt;
  const auto [from, to] = in_medium(eye_y, plane.w.y, distance);

  // Each angle from its own sides: as a difference it would lose its digits where it is small.
  const auto psi = [&, from_foot = D * plane.cos_alpha, across = D * plane.sin_alpha](double t) {
    return std::atan2(across, t - from_foot);
  };
  if (std::isinf(to)) return {plane, D, from, light_height, psi(from), 0.0, psi(from)};
  const double phi_d =
      std::atan2((to - from) * plane.sin_alpha, D - (from + to) * plane.cos_alpha + from / D * to);
  return {plane, D, from, light_height, psi(from), psi(to), phi_d};
}

}  // namespace airlight::reference
