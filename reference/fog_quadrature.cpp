#include "reference/fog_quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/phase.h"

// The light's path in the medium is a + b long, a from where the view ray enters it to the sample, b from the
// sample to the light or to the layer's top below it. With light and eye in the medium, a + b = t + r =
// D (cos α + sin α cot(ψ/2)). Of r, a light h over the top leaves out h/c, c(ψ) = −(w_y cos ψ + q_y sin ψ)
// being the light ray's descent by length.
//
// The integrand exp(−σ (a + b)) p(−cos ψ) is smooth on every scale but four: the optical depth may change
// fast, it grows without bound as ψ → 0, it would where a light ray from above the layer were level, and the
// lobe of a Henyey-Greenstein phase function is 1 − |g| wide. Panels that are no longer than each of these
// scales, measured where the panel begins, leave Gauss–Legendre quadrature an error near rounding. A light's
// texture, its cone and its range add scales of their own, and kinks, where panels end (light_texture.h,
// light_shape.h).

namespace airlight::reference {

namespace {

/// Optical depth that one panel may span: 8 nodes integrate e^{−x} over it to 1e-9.
constexpr double k_panel_depth = 6.0;
/// Light this much deeper than at the eye is left out: e^{−60} of the unshadowed airlight.
constexpr double k_depth_range = 60.0;
/// The last part of an endless ray, relative to ψ at the eye, that is one panel: nothing there counts.
constexpr double k_psi_range = 1e-9;

struct Node {
  double x, weight;
};

// Abramowitz and Stegun, Handbook of Mathematical Functions (1964), table 25.4; the nodes at ±x.
constexpr std::array<Node, 1> k_gauss_2{{{0.5773502691896257, 1.0}}};
constexpr std::array<Node, 2> k_gauss_4{
    {{0.3399810435848563, 0.6521451548625461}, {0.8611363115940526, 0.3478548451374538}}};
constexpr std::array<Node, 4> k_gauss_8{{{0.1834346424956498, 0.3626837833783620},
                                         {0.5255324099163290, 0.3137066458778873},
                                         {0.7966664774136267, 0.2223810344533745},
                                         {0.9602898564975363, 0.1012285362903763}}};

template <std::size_t Half, class Function>
auto gauss_legendre(const std::array<Node, Half>& rule, double from, double to, const Function& f) {
  const double middle = 0.5 * (from + to), half = 0.5 * (from - to);
  decltype(f(middle)) sum(0.0);
  for (const Node& node : rule) sum += node.weight * (f(middle - half * node.x) + f(middle + half * node.x));
  return half * sum;
}

}  // namespace

FogQuadrature::FogQuadrature(const ViewRay& ray, double sigma_t, const scene::Medium& medium)
    : medium_(medium),
      g_(medium.phase == scene::PhaseFunction::henyey_greenstein ||
                 medium.phase == scene::PhaseFunction::hoffman_preetham
             ? static_cast<double>(medium.g)
             : 0.0),
      depth_scale_(sigma_t * ray.D * ray.sin_alpha),
      depth_offset_(sigma_t * (ray.D * ray.cos_alpha - ray.from)),
      depth_above_(sigma_t * ray.light_height),
      w_y_(ray.w.y),
      q_y_(ray.q.y),
      // A ray that climbs to the layer's top may come to where less fog lies below the light.
      only_deepens_(ray.light_height == 0.0 || ray.w.y <= 0.0),
      smallest_psi_(k_psi_range * ray.psi_start) {
  const double at_start = optical_depth(ray.psi_start);
  deepest_ = k_depth_range + (only_deepens_ ? at_start : std::min(at_start, optical_depth(ray.psi_end)));
}

double FogQuadrature::descent(double psi) const {
  // No less than straight to the light from below the top, where rounding says so.
  return std::max(-(w_y_ * std::cos(psi) + q_y_ * std::sin(psi)),
                  depth_above_ / depth_scale_ * std::sin(psi));
}

double FogQuadrature::descent_slope(double psi) const {
  return w_y_ * std::sin(psi) - q_y_ * std::cos(psi);
}

double FogQuadrature::optical_depth(double psi) const {
  const double endless = depth_offset_ + depth_scale_ / std::tan(0.5 * psi);  // view_ray.h (3)
  return depth_above_ == 0.0 ? endless : endless - depth_above_ / descent(psi);
}

double FogQuadrature::integrand(double psi) const {
  return std::exp(-optical_depth(psi)) * phase(medium_, -std::cos(psi));
}

bool FogQuadrature::has_narrow_lobe() const {
  return std::abs(g_) > 0.8;
}

bool FogQuadrature::lobe_is_smooth(double psi, double step) const {
  // The rule errs by h²/24 of the second derivative: a step of a sixteenth of the lobe's width by 5e-4 of it.
  constexpr double k_steps = 16.0;
  return k_steps * step < std::hypot(g_ > 0.0 ? std::numbers::pi - psi : psi, 1.0 - std::abs(g_));
}

/// How far the optical depth of a light ray from above the layer goes up and down from ψ to `psi_to`, at
/// most.
double FogQuadrature::depth_variation(double psi, double psi_to) const {
  const double here = descent(psi), there = descent(psi_to);
  const bool passes_steepest = descent_slope(psi) <= 0.0 && descent_slope(psi_to) >= 0.0;
  const double steepest = passes_steepest ? std::hypot(w_y_, q_y_) : std::max(here, there);
  return depth_scale_ * (1.0 / std::tan(0.5 * psi_to) - 1.0 / std::tan(0.5 * psi)) +
         depth_above_ * (1.0 / std::min(here, there) - 1.0 / steepest);
}

double FogQuadrature::panel_end(double psi, double optical_depth) const {
  const double by_distance = 0.5 * psi;
  // A backward lobe lies at ψ = 0, where panels shrink anyway.
  const double by_lobe = g_ > 0.0 ? psi - std::hypot(std::numbers::pi - psi, 1.0 - g_) : 0.0;
  if (depth_above_ > 0.0) {
    const double to_level = std::atan2(descent(psi), std::abs(descent_slope(psi)));
    double end = std::max({by_distance, by_lobe, psi - 0.25 * to_level});
    while (depth_variation(psi, end) > k_panel_depth) end = 0.5 * (psi + end);
    return end;
  }
  const double cotangent = (optical_depth + k_panel_depth - depth_offset_) / depth_scale_;
  const double by_depth = 2.0 * std::atan(1.0 / cotangent);
  return std::max({by_distance, cotangent > 0.0 ? by_depth : 0.0, by_lobe});
}

/// @param f       the integrand, of ψ
/// @param longest what else bounds the length of a panel from ψ on
/// @param is_even whether a small part of a panel's length leaves the integrand nearly constant
template <class Value, class Integrand, class Longest>
Value FogQuadrature::sum_panels(double psi_from, double psi_to, const Integrand& f,
                                const Longest& longest_from, bool is_even) const {
  Value sum(0.0);
  double psi = psi_from;
  while (psi > psi_to) {
    const double depth = optical_depth(psi);
    const bool is_dark = !(depth < deepest_);
    if (is_dark && only_deepens_) break;
    const double longest =
        psi > smallest_psi_ ? std::min(psi - panel_end(psi, depth), longest_from(psi)) : psi;
    const double length = std::min(longest, psi - psi_to);
    const double next = length < longest ? psi_to : psi - longest;
    for (int part = 0; part < parts_ && !is_dark; ++part) {
      const double from = psi + (next - psi) * part / parts_, to = psi + (next - psi) * (part + 1) / parts_;
      // Short lit runs between many shadows are common, and need few nodes.
      if (is_even && length < longest / 64.0) {
        sum += gauss_legendre(k_gauss_2, from, to, f);
      } else if (is_even && length < longest / 8.0) {
        sum += gauss_legendre(k_gauss_4, from, to, f);
      } else {
        sum += gauss_legendre(k_gauss_8, from, to, f);
      }
    }
    psi = next;
  }
  return sum;
}

glm::dvec3 FogQuadrature::integral(double psi_from, double psi_to, const LightAlongRay* texture,
                                   const LightShape* shape) const {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 sum(0.0);
  // A share that falls to 0 changes by all of itself in the shortest run.
  const auto add_piece = [&](double piece_from, double piece_to, bool is_even) {
    const auto untextured = [&](double psi) {
      return is_even ? integrand(psi) : integrand(psi) * shape->at(psi);
    };
    const auto longest = [&](double psi) { return is_even ? k_infinity : shape->smooth_length(psi); };
    if (!texture) {
      sum += glm::dvec3(sum_panels<double>(piece_from, piece_to, untextured, longest, is_even));
      return;
    }
    texture->for_each_piece(piece_from, piece_to, [&](double from, double to) {
      sum += sum_panels<glm::dvec3>(
          from, to, [&](double psi) { return untextured(psi) * texture->at(psi); },
          [&](double psi) { return std::min(texture->smooth_length(psi), longest(psi)); }, is_even);
    });
  };
  if (shape)
    shape->for_each_piece(psi_from, psi_to, add_piece);
  else
    add_piece(psi_from, psi_to, true);
  return sum;
}

}  // namespace airlight::reference
