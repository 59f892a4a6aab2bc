#pragma once

#include <glm/glm.hpp>

namespace airlight::reference {

/// One view ray in the half-plane that it spans with the light.
///
/// All vectors are relative to the light. With ψ = π − (α + φ), the angle at the sample between the view ray
/// and the light ray, every quantity of the airlight is short (derived in view_ray.cpp):
///
///     direction of the light ray   w cos ψ + q sin ψ           (1)
///     length of the light ray      r = D sin α / sin ψ         (2)
///     length of the light's path   t + r = D (cos α + sin α cot(ψ/2))   (3)
///     cosine of the scattering     cos(α + φ) = −cos ψ         (4)
///
/// ψ falls from π − α at the eye to `psi_end`; φ grows from 0 to φ_d by as much, since |dφ| = |dψ|. None of
/// the forms loses digits: near the eye, near the light, at infinity (ψ → 0), or with the light behind the
/// eye (α → π), where uniform steps in φ become steps in t/(D + t).
struct ViewRay {
  glm::dvec3 w;      ///< unit direction of the view ray
  glm::dvec3 q;      ///< unit vector from the light to the nearest point of the view ray's line
  double D;          ///< from the eye to the light [m]
  double sin_alpha;  ///< α ∈ (0, π): angle at the eye between the direction to the light and w
  double cos_alpha;
  double psi_eye;  ///< π − α [rad]
  double psi_end;  ///< ψ of the first surface; 0 where the ray hits nothing
  double phi_d;    ///< psi_eye − psi_end [rad], the range of φ

  /// ψ at the fraction s ∈ [0, 1] of the range of φ.
  double psi(double s) const { return psi_end + (1.0 - s) * phi_d; }

  /// The first surface, or infinity, in each axis that the ray moves along.
  /// @param eye relative to the light [m], as is the point
  glm::dvec3 end(const glm::dvec3& eye) const;
};

/// The smallest distance of α from π [rad]. The airlight is even in π − α, so that a ray at the light's
/// antipode is evaluated here with a relative error of the order of 1e-12.
inline constexpr double k_smallest_psi_eye = 1e-6;

/// @param eye            relative to the light [m]
/// @param direction      unit direction through the pixel centre
/// @param right          the camera's right: where a ray straight at or away from the light is moved to
/// @param distance       of the first hit along the ray [m]; 0 for none
/// @param smallest_alpha [rad], a quarter of a pixel: a ray nearer to the light is evaluated there
ViewRay make_view_ray(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& right,
                      double distance, double smallest_alpha);

}  // namespace airlight::reference
