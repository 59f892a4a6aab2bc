#include "reference/shadow_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace airlight::reference {

namespace {

/// Lit runs shorter than this, relative to the ray's range of φ or to t, are rounding: where a surface ends
/// the ray, its own shadow begins there to the last digits.
constexpr double k_shortest = 1e-12;

/// The segment in which a half-plane's plane cuts a triangle, its ends by growing y: x along the view ray, y
/// across it, away from the light.
struct Segment {
  glm::dvec2 p, q;

  double x_at(double y) const { return p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x); }
};

/// Where a segment casts its shadow on the view ray, between any two u; none where it casts none.
struct Shadow {
  double a, b;
};

// Only what lies between light and ray casts a shadow on it.

std::optional<Shadow> shadow(const ViewRay& ray, const Segment& s) {
  const double h = ray.D * ray.sin_alpha;
  if (s.q.y <= 0.0 || s.p.y >= h) return {};
  const double u_q = s.q.y > h ? s.x_at(h) / h : s.q.x / s.q.y;
  const double u_p =
      s.p.y > 0.0 ? s.p.x / s.p.y : std::copysign(std::numeric_limits<double>::infinity(), s.x_at(0.0));
  return Shadow{u_p, u_q};
}

std::optional<Shadow> shadow(const SunRay& ray, const Segment& s) {
  if (s.p.y >= 0.0) return {};
  const double cotangent = ray.cos_alpha / ray.sin_alpha;
  const double t_q = s.q.y > 0.0 ? s.x_at(0.0) : s.q.x + s.q.y * cotangent;
  return Shadow{s.p.x + s.p.y * cotangent, t_q};
}

}  // namespace

void Occluders::clear() {
  corners_.clear();
  triangles_.clear();
  for (int i = 0; i < 3; ++i) {
    x_[i].clear();
    y_[i].clear();
    z_[i].clear();
  }
  margin_.clear();
}

void Occluders::add(const Corners& corners, std::uint32_t triangle) {
  if (sun_ ? is_edge_on_to_sun(corners, *sun_) : is_edge_on(corners)) return;
  corners_.push_back(corners);
  if (model_) triangles_.push_back(triangle);
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

template <class Ray>
void ShadowIntervals::add_shadow(const Ray& ray, const Interval& range, const Occluders& occluders,
                                 std::size_t i) {
  const Corners& corners = occluders.corners(i);
  const glm::dvec3 n = glm::cross(ray.w, ray.q);
  const double side[3] = {glm::dot(n, corners[0]), glm::dot(n, corners[1]), glm::dot(n, corners[2])};
  const bool positive[3] = {side[0] >= 0.0, side[1] >= 0.0, side[2] >= 0.0};
  if (positive[0] == positive[1] && positive[1] == positive[2]) return;
  const std::size_t alone = positive[0] == positive[1] ? 2 : positive[1] == positive[2] ? 0 : 1;

  // The segment in which the half-plane's plane cuts the triangle.
  std::size_t first = (alone + 1) % 3, second = (alone + 2) % 3;  // the edges from `alone` that are cut
  const auto ends_of = [&](std::size_t other) {
    return positive[alone] ? std::pair(other, alone) : std::pair(alone, other);
  };
  const auto cut = [&](std::size_t other) {
    const auto [below, above] = ends_of(other);
    const glm::dvec3 point =
        corners[below] + side[below] / (side[below] - side[above]) * (corners[above] - corners[below]);
    return glm::dvec2(glm::dot(ray.w, point), glm::dot(ray.q, point));
  };
  Segment segment{cut(first), cut(second)};
  if (segment.p.y > segment.q.y) {
    std::swap(segment.p, segment.q);
    std::swap(first, second);
  }

  const auto add = [&](const Segment& part) {
    const std::optional<Shadow> cast = shadow(ray, part);
    if (!cast) return;
    const double from = std::max(std::min(cast->a, cast->b), range.from),
                 to = std::min(std::max(cast->a, cast->b), range.to);
    if (from >= to) return;
    if (const glm::uvec3* attenuation = occluders.attenuation(i))
      tinted_.push_back({{from, to}, *attenuation});
    else
      intervals_.push_back({from, to});
  };
  const CutOuts* cut_outs = occluders.cut_outs(i);
  if (!cut_outs) return add(segment);

  const auto weights = [&](std::size_t other) {
    const auto [below, above] = ends_of(other);
    const double part = side[below] / (side[below] - side[above]);
    glm::dvec3 of_corners(0.0);
    of_corners[static_cast<int>(below)] = 1.0 - part;
    of_corners[static_cast<int>(above)] = part;
    return of_corners;
  };
  cut_outs->find_parts(occluders.triangle(i), weights(first), weights(second), parts_);
  const auto at = [&](double part) {
    return part == 0.0 ? segment.p : part == 1.0 ? segment.q : glm::mix(segment.p, segment.q, part);
  };
  for (const CutOuts::Part& part : parts_) add({at(part.from), at(part.to)});
}

template <class Ray>
void ShadowIntervals::find_shadows(const Ray& ray, const Interval& range, Occluders& occluders) {
  intervals_.clear();
  tinted_.clear();
  occluders.find_crossing(glm::cross(ray.w, ray.q), crossing_);
  for (const std::uint32_t i : crossing_) add_shadow(ray, range, occluders, i);
  std::sort(intervals_.begin(), intervals_.end(),
            [](const Interval& a, const Interval& b) { return a.from < b.from; });
}

/// Calls f(from, to) with what no shadow covers of the range of u.
template <class Function>
void ShadowIntervals::for_each_gap(const Interval& range, const Function& f) const {
  double lit_from = range.from;
  for (const Interval& shadow : intervals_) {
    if (shadow.from > lit_from) f(lit_from, shadow.from);
    lit_from = std::max(lit_from, shadow.to);
  }
  if (lit_from < range.to) f(lit_from, range.to);
}

/// Calls f(from, to, share) with the gaps, cut where the share of the light that arrives changes.
template <class Function>
void ShadowIntervals::for_each_lit(const Interval& range, const Function& f) {
  changes_.clear();
  for (const Tinted& tinted : tinted_) {
    const glm::vec<3, std::int64_t> attenuation(tinted.attenuation);
    changes_.push_back({tinted.interval.from, attenuation});
    changes_.push_back({tinted.interval.to, -attenuation});
  }
  std::sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) { return a.at < b.at; });

  glm::vec<3, std::int64_t> sum(0);
  auto next = changes_.begin();
  const auto pass = [&](double at) {
    for (; next != changes_.end() && next->at <= at; ++next) sum += next->attenuation;
  };
  for_each_gap(range, [&](double from, double to) {
    for (double at = from; at < to;) {
      pass(at);
      const double end = next == changes_.end() ? to : std::min(next->at, to);
      const glm::dvec3 share = scene::share_left(
          glm::uvec3(glm::min(sum, glm::vec<3, std::int64_t>(scene::Attenuation::k_nothing_left))));
      if (share != glm::dvec3(0.0)) f(at, end, share);
      at = end;
    }
  });
}

void ShadowIntervals::trace(const ViewRay& ray, Occluders& occluders) {
  const Interval range{
      (ray.from - ray.D * ray.cos_alpha) / (ray.D * ray.sin_alpha),
      ray.psi_end > 0.0 ? 1.0 / std::tan(ray.psi_end) : std::numeric_limits<double>::infinity()};
  find_shadows(ray, range, occluders);

  lit_.clear();
  for_each_lit(range, [&](double from, double to, const glm::dvec3& share) {
    const double psi_from = from == range.from ? ray.psi_start : std::atan2(1.0, from);
    const double psi_to = to == range.to ? ray.psi_end : std::atan2(1.0, to);
    if (psi_from - psi_to > k_shortest * ray.phi_d) lit_.push_back({psi_from, psi_to, share});
  });
}

void ShadowIntervals::trace(const SunRay& ray, Occluders& occluders) {
  const Interval range{ray.from, ray.to};
  find_shadows(ray, range, occluders);
  lit_.clear();
  for_each_lit(range, [&](double from, double to, const glm::dvec3& share) {
    if (from < to * (1.0 - k_shortest)) lit_.push_back({from, to, share});
  });
}

}  // namespace airlight::reference
