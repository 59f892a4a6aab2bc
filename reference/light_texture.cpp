#include "reference/light_texture.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace airlight::reference {

using std::numbers::pi;

namespace {

/// Panels towards a pole shrink no further than this [rad]: light rays that pass nearer to it see their
/// longitude jump.
constexpr double k_shortest = 1e-6;

}  // namespace

LightLookup::LightLookup(const scene::LightTexture& texture) : texture_(texture) {
  const glm::ivec2 size = texture.size();
  // Where the width is even, two meridians make one plane through the poles.
  const int planes = size.x % 2 == 0 ? size.x / 2 : size.x;
  for (int column = 0; column < planes; ++column) {
    const double longitude = 2 * pi * (0.5 - (column + 0.5) / size.x);
    meridians_.emplace_back(std::cos(longitude), std::sin(longitude));
  }
  for (int row = 0; row < size.y; ++row) parallels_.push_back(std::sin(pi * (0.5 - (row + 0.5) / size.y)));
}

glm::dvec3 LightLookup::at(const glm::dvec3& direction) const {
  const glm::ivec2 size = texture_.size();
  const double longitude = std::atan2(direction.x, direction.z);
  const double latitude = std::atan2(direction.y, std::hypot(direction.x, direction.z));
  const double column = (0.5 - longitude / (2 * pi)) * size.x - 0.5;
  const double row = std::clamp((0.5 - latitude / pi) * size.y - 0.5, 0.0, size.y - 1.0);
  const double across = column - std::floor(column), down = row - std::floor(row);
  const int left = (static_cast<int>(std::floor(column)) + size.x) % size.x, right = (left + 1) % size.x;
  const int upper = static_cast<int>(row), lower = std::min(upper + 1, size.y - 1);
  const auto texel = [&](int x, int y) {
    return glm::dvec3(texture_.texels()[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                                        static_cast<std::size_t>(x)]);
  };
  return glm::mix(glm::mix(texel(left, upper), texel(right, upper), across),
                  glm::mix(texel(left, lower), texel(right, lower), across), down);
}

glm::dvec3 LightAlongRay::direction(double psi) const {
  return std::cos(psi) * w_ + std::sin(psi) * q_;  // view_ray.h (1)
}

double LightAlongRay::smooth_length(double psi) const {
  const glm::dvec3 d = direction(psi);
  return std::max(0.5 * std::hypot(d.x, d.z), k_shortest);
}

void LightAlongRay::aim(const ViewRay& ray) {
  w_ = ray.w;
  q_ = ray.q;
  cuts_.clear();
  const auto cut = [&](double psi) {
    if (psi < 0.0) psi += 2 * pi;
    if (psi > ray.psi_end && psi < ray.psi_start) cuts_.push_back(psi);
  };
  // The sine of the latitude is highest · cos(ψ − nearest): nearest to one pole there, to the other half a
  // turn on.
  const double highest = std::hypot(w_.y, q_.y), nearest = std::atan2(q_.y, w_.y);
  cut(nearest);
  cut(nearest > 0.0 ? nearest - pi : nearest + pi);
  for (double sine : lookup_.parallels_) {
    if (std::abs(sine) >= highest) continue;
    const double aside = std::acos(sine / highest);
    cut(nearest + aside > pi ? nearest + aside - 2 * pi : nearest + aside);
    cut(nearest - aside < -pi ? nearest - aside + 2 * pi : nearest - aside);
  }
  // On a meridian x cos λ = z sin λ; of its two crossings, half a turn apart, one has ψ in [0, π).
  for (const glm::dvec2& meridian : lookup_.meridians_) {
    const double a = w_.x * meridian.x - w_.z * meridian.y, b = q_.x * meridian.x - q_.z * meridian.y;
    const double psi = std::atan2(-a, b);
    cut(psi < 0.0 ? psi + pi : psi);
  }
  std::sort(cuts_.begin(), cuts_.end(), std::greater<>());
}

}  // namespace airlight::reference
