#include "reference/shadow_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace airlight::reference {

namespace {

/// Lit runs shorter than this, relative to the ray's range of φ, are rounding: where a surface ends the ray,
/// its own shadow begins there to the last digits.
constexpr double k_shortest = 1e-12;

}  // namespace

void Occluders::clear() {
  corners_.clear();
  for (int i = 0; i < 3; ++i) {
    x_[i].clear();
    y_[i].clear();
    z_[i].clear();
  }
  margin_.clear();
}

void Occluders::add(const Corners& corners) {
  if (is_edge_on(corners)) return;
  corners_.push_back(corners);
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3& c = corners[i];
    x_[i].push_back(static_cast<float>(c.x));
    y_[i].push_back(static_cast<float>(c.y));
    z_[i].push_back(static_cast<float>(c.z));
    largest = std::max(largest, std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
  }
  // Corner, normal, products and sums are each rounded to 2⁻²⁴: no more than 6 such in a term.
  margin_.push_back(static_cast<float>(1e-6 * largest));
}

void Occluders::find_crossing(const glm::dvec3& n, std::vector<std::uint32_t>& crossing) {
  const std::size_t size = count();
  const glm::vec3 m(n);
  flags_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const float a = m.x * x_[0][i] + m.y * y_[0][i] + m.z * z_[0][i];
    const float b = m.x * x_[1][i] + m.y * y_[1][i] + m.z * z_[1][i];
    const float c = m.x * x_[2][i] + m.y * y_[2][i] + m.z * z_[2][i];
    const float ab_least = a < b ? a : b, ab_most = a < b ? b : a;
    const float least = ab_least < c ? ab_least : c, most = ab_most < c ? c : ab_most;
    flags_[i] =
        static_cast<std::int32_t>(least <= margin_[i]) & static_cast<std::int32_t>(most >= -margin_[i]);
  }
  crossing.resize(size);
  std::size_t found = 0;
  for (std::size_t i = 0; i < size; ++i) {
    crossing[found] = static_cast<std::uint32_t>(i);
    found += static_cast<std::size_t>(flags_[i]);
  }
  crossing.resize(found);
}

void ShadowIntervals::add_shadow(const ViewRay& ray, double u_eye, double u_end, const Corners& corners) {
  const glm::dvec3 n = glm::cross(ray.w, ray.q);
  const double side[3] = {glm::dot(n, corners[0]), glm::dot(n, corners[1]), glm::dot(n, corners[2])};
  const bool positive[3] = {side[0] >= 0.0, side[1] >= 0.0, side[2] >= 0.0};
  if (positive[0] == positive[1] && positive[1] == positive[2]) return;
  const std::size_t alone = positive[0] == positive[1] ? 2 : positive[1] == positive[2] ? 0 : 1;

  // The segment in which the half-plane's plane cuts the triangle.
  const auto cut = [&](std::size_t other) {
    const auto [below, above] = positive[alone] ? std::pair(other, alone) : std::pair(alone, other);
    const glm::dvec3 point =
        corners[below] + side[below] / (side[below] - side[above]) * (corners[above] - corners[below]);
    return glm::dvec2(glm::dot(ray.w, point), glm::dot(ray.q, point));
  };
  glm::dvec2 p = cut((alone + 1) % 3), q = cut((alone + 2) % 3);
  if (p.y > q.y) std::swap(p, q);

  // Only what lies between light and ray casts a shadow on it.
  const double h = ray.D * ray.sin_alpha;
  if (q.y <= 0.0 || p.y >= h) return;
  const auto x_at = [&](double y) { return p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x); };
  const double u_q = q.y > h ? x_at(h) / h : q.x / q.y;
  const double u_p =
      p.y > 0.0 ? p.x / p.y : std::copysign(std::numeric_limits<double>::infinity(), x_at(0.0));
  const double from = std::max(std::min(u_p, u_q), u_eye), to = std::min(std::max(u_p, u_q), u_end);
  if (from < to) intervals_.push_back({from, to});
}

void ShadowIntervals::trace(const ViewRay& ray, Occluders& occluders) {
  const double u_eye = -ray.cos_alpha / ray.sin_alpha;
  const double u_end =
      ray.psi_end > 0.0 ? 1.0 / std::tan(ray.psi_end) : std::numeric_limits<double>::infinity();
  intervals_.clear();
  occluders.find_crossing(glm::cross(ray.w, ray.q), crossing_);
  for (const std::uint32_t i : crossing_) add_shadow(ray, u_eye, u_end, occluders.corners(i));
  std::sort(intervals_.begin(), intervals_.end(),
            [](const Interval& a, const Interval& b) { return a.from < b.from; });

  lit_.clear();
  const auto psi = [](double u) { return std::atan2(1.0, u); };
  double lit_from = u_eye;
  const auto add_lit = [&](double psi_to) {
    const double psi_from = lit_from == u_eye ? ray.psi_eye : psi(lit_from);
    if (psi_from - psi_to > k_shortest * ray.phi_d) lit_.push_back({psi_from, psi_to});
  };
  for (const Interval& shadow : intervals_) {
    if (shadow.from > lit_from) add_lit(psi(shadow.from));
    lit_from = std::max(lit_from, shadow.to);
  }
  if (lit_from < u_end) add_lit(ray.psi_end);
}

}  // namespace airlight::reference
