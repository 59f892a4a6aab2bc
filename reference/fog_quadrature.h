#pragma once

#include "reference/light_texture.h"
#include "reference/view_ray.h"
#include "scene/scene.h"

namespace airlight::reference {

/// ∫ e^{−σ(t+r)} p(α+φ) dφ along one view ray, by Gauss–Legendre quadrature in double precision.
class FogQuadrature {
 public:
  /// @param sigma_t extinction coefficient σ = σ_s + σ_a of one channel [1/m]
  /// @param medium  for its phase function; kept by reference
  FogQuadrature(const ViewRay& ray, double sigma_t, const scene::Medium& medium);

  /// The integral over ψ ∈ [`psi_to`, `psi_from`] [1/sr·rad], to a relative error below 1e-6 of the integral
  /// over the whole ray without shadow.
  double integral(double psi_from, double psi_to) const;

  /// The same with the light's texture under the integral, RGB, each of the same σ.
  glm::dvec3 integral(double psi_from, double psi_to, const LightAlongRay& light) const;

  /// Whether the phase function has a lobe that steps in φ may not resolve.
  bool has_narrow_lobe() const;
  /// Whether the midpoint rule follows a narrow lobe over a step [rad] around ψ.
  bool lobe_is_smooth(double psi, double step) const;

 private:
  template <class Value, class Integrand, class Longest>
  Value sum_panels(double psi_from, double psi_to, const Integrand& f, const Longest& longest) const;
  double integrand(double psi) const;
  double panel_end(double psi, double optical_depth) const;

  const scene::Medium& medium_;
  double g_;             ///< of the phase function's lobe; 0 without one
  double depth_scale_;   ///< σ D sin α
  double depth_offset_;  ///< σ D cos α: the optical depth of the light's path is offset + scale · cot(ψ/2)
  double deepest_;       ///< optical depth beyond which nothing is added
  double smallest_psi_;  ///< [rad], below which nothing is added
};

}  // namespace airlight::reference
