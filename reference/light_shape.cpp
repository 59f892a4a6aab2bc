#include "reference/light_shape.h"

#include <cmath>
#include <limits>
#include <numbers>

// In the plane of light and view ray the axis a of a cone has a part of length A at the angle ψ_a, and
// A² + h² = 1 with its part h across. The cosine of a light ray's angle to the axis is A cos(ψ − ψ_a), which
// is the cosine of a half-angle γ at two roots,
//
//     ψ = ψ_a ± δ        tan δ = √(sin² γ − h²) / cos γ                            (1)
//
// or nowhere. Of narrow cones a cosine says little, so that the ramp is taken from 1 − cos:
//
//     1 − A cos x = h² / (1 + A) + 2 A sin²(x / 2)                                 (2)
//
// The sphere of the range is where sin ψ = D sin α / range (view_ray.h, 2), twice as well.

namespace airlight::reference {

using std::numbers::pi;

namespace {

/// 1 − cos x.
double fall(double x) {
  const double sine = std::sin(0.5 * x);
  return 2.0 * sine * sine;
}

}  // namespace

LightShape::LightShape(const scene::Light& light) : cone_(light.cone), range_(light.range) {
  if (!cone_) return;
  fall_inner_ = fall(cone_->inner);
  fall_outer_ = fall(cone_->outer);
}

void LightShape::aim(const ViewRay& ray) {
  Piece lit{.from = ray.psi_start, .to = ray.psi_end, .is_even = !range_};
  if (range_) {
    relative_ = ray.D * ray.sin_alpha / *range_;
    const double crossing = relative_ < 1.0 ? std::asin(relative_) : 0.5 * pi;
    lit.from = std::min(lit.from, pi - crossing);
    lit.to = std::max(lit.to, crossing);
  }
  pieces_ = {lit};
  if (!cone_) return;

  const double along = glm::dot(cone_->axis, ray.w), outward = glm::dot(cone_->axis, ray.q);
  const double across = std::abs(glm::dot(cone_->axis, glm::cross(ray.w, ray.q)));
  in_plane_ = std::hypot(along, outward);
  least_fall_ = across * across / (1.0 + in_plane_);
  // Half-angles are no more than a right one: all that a cone lights on the ray, where 0 ≤ ψ < π, lies
  // together, if the angle is counted from here.
  nearest_ = std::atan2(outward, along);
  if (nearest_ < -0.5 * pi) nearest_ += 2.0 * pi;
  const auto between_roots = [&](double half_angle, bool is_even) {
    const double sine = std::sin(half_angle);
    if (sine <= across) return Piece{};
    const double aside = std::atan2(std::sqrt((sine - across) * (sine + across)), std::cos(half_angle));
    return Piece{.from = std::min(lit.from, nearest_ + aside),
                 .to = std::max(lit.to, nearest_ - aside),
                 .is_even = is_even};
  };
  const Piece outer = between_roots(cone_->outer, cone_->inner == cone_->outer && lit.is_even);
  const Piece inner = between_roots(cone_->inner, lit.is_even);
  if (cone_->inner == cone_->outer || !(inner.to < inner.from))
    pieces_ = {outer};
  else
    pieces_ = {Piece{outer.from, inner.from, false}, inner, Piece{inner.to, outer.to, false}};
}

double LightShape::at(double psi) const {
  double share = 1.0;
  if (range_) {
    const double q = relative_ / std::sin(psi);
    share = std::max(1.0 - q * q * q * q, 0.0);
  }
  if (cone_) {
    const double inside = fall_outer_ - (least_fall_ + in_plane_ * fall(psi - nearest_));
    if (fall_inner_ == fall_outer_) return inside >= 0.0 ? share : 0.0;
    const double ramp = std::clamp(inside / (fall_outer_ - fall_inner_), 0.0, 1.0);
    share *= ramp * ramp;
  }
  return share;
}

double LightShape::smooth_length(double psi) const {
  return range_ ? 0.5 * (pi - psi) : std::numeric_limits<double>::infinity();
}

}  // namespace airlight::reference
