#pragma once

#include <array>
#include <cstddef>

#include "reference/light_shape.h"
#include "reference/light_texture.h"
#include "reference/view_ray.h"
#include "scene/scene.h"

namespace airlight::reference {

/// σ_s I / (D sin α): what the integral over φ is multiplied with, RGB. A light's texture, cone and
/// range belong under the integral.
inline glm::dvec3 airlight_scale(const ViewRay& ray, const scene::Light& light, const scene::Medium& medium) {
  return glm::dvec3(medium.sigma_s) * glm::dvec3(light.intensity) / (ray.D * ray.sin_alpha);
}

/// ∫ e^{−σ(a+b)} p(α+φ) dφ along one view ray, by Gauss–Legendre quadrature in double precision.
class FogQuadrature {
 public:
  /// @param sigma_t extinction coefficient σ = σ_s + σ_a of one channel [1/m]
  /// @param medium  for its phase function; kept by reference
  FogQuadrature(const ViewRay& ray, double sigma_t, const scene::Medium& medium);

  /// No integral is farther off than this part of itself: of two million random ones, against four times the
  /// nodes, the worst was off by 4e-8; of a million in layers none by more.
  static constexpr double k_error = 1e-7;

  /// Cuts each panel of the quadrature in so many.
  void refine(int parts) { parts_ = parts; }

  /// The integral over ψ ∈ [`psi_to`, `psi_from`] [1/sr·rad], RGB.
  /// @param texture, shape of the light, which belong under the integral; nullptr without
  glm::dvec3 integral(double psi_from, double psi_to, const LightAlongRay* texture = nullptr,
                      const LightShape* shape = nullptr) const;

  /// Whether the phase function has a lobe that steps in φ may not resolve.
  bool has_narrow_lobe() const;
  /// Whether the midpoint rule follows a narrow lobe over a step [rad] around ψ.
  bool lobe_is_smooth(double psi, double step) const;

 private:
  template <class Value, class Integrand, class Longest>
  Value sum_panels(double psi_from, double psi_to, const Integrand& f, const Longest& longest,
                   bool is_even) const;
  double optical_depth(double psi) const;
  double integrand(double psi) const;
  double descent(double psi) const;
  double descent_slope(double psi) const;
  double depth_variation(double psi, double psi_to) const;
  double panel_end(double psi, double optical_depth) const;

  const scene::Medium& medium_;
  int parts_ = 1;
  double g_;            ///< of the phase function's lobe; 0 without one
  double depth_scale_;  ///< σ D sin α
  double depth_offset_;  ///< σ (D cos α − from): the optical depth of the light's path is offset + scale ·
                         ///< cot(ψ/2)
  double depth_above_;  ///< σ · the light's height over the layer: less that / descent, of the path above it
  double w_y_, q_y_;    ///< of the view ray
  bool only_deepens_;   ///< along the ray
  double deepest_;      ///< optical depth beyond which nothing is added
  double smallest_psi_;  ///< [rad], below which there is one panel
};

/// Integrates along a view ray channel by channel.
/// @param scale     what the integrals will be multiplied with: a channel of 0 is left out
/// @param integrate std::array<glm::dvec3, N>(FogQuadrature&): N integrals as if all channels had the same σ;
/// called once for neighbouring channels that do
template <std::size_t N, class Integrate>
std::array<glm::dvec3, N> integrate_channels(const ViewRay& ray, const scene::Medium& medium,
                                             const glm::dvec3& scale, const Integrate& integrate) {
  const glm::dvec3 sigma_t = glm::dvec3(medium.sigma_s) + glm::dvec3(medium.sigma_a);
  std::array<glm::dvec3, N> integrals{}, of_sigma{};
  for (int channel = 0; channel < 3; ++channel) {
    if (scale[channel] == 0.0) continue;
    if (channel == 0 || sigma_t[channel] != sigma_t[channel - 1] || scale[channel - 1] == 0.0) {
      FogQuadrature fog(ray, sigma_t[channel], medium);
      of_sigma = integrate(fog);
    }
    for (std::size_t i = 0; i < N; ++i) integrals[i][channel] = of_sigma[i][channel];
  }
  return integrals;
}

}  // namespace airlight::reference
