#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "reference/light_plane.h"

namespace airlight::reference {

/// One view ray in the half-plane that it spans with a point light.
///
/// All vectors are relative to the light. With ψ = π − (α + φ), the angle at the sample between the view ray
/// and the light ray, every quantity of the airlight is short (derived in view_ray.cpp):
///
///     direction of the light ray   w cos ψ + q sin ψ           (1)
///     length of the light ray      r = D sin α / sin ψ         (2)
///     length of the light's path   t + r = D (cos α + sin α cot(ψ/2))   (3)
///     cosine of the scattering     cos(α + φ) = −cos ψ         (4)
///
/// ψ falls from π − α at the eye, or less where the ray enters a layer, to `psi_end`; φ grows from 0 to φ_d
/// by as much, since |dφ| = |dψ|. None of the forms loses digits: near the eye, near the light, at infinity
/// (ψ → 0), or with the light behind the eye (α → π), where uniform steps in φ become steps in t/(D + t).
struct ViewRay : LightPlane {
  double D;             ///< from the eye to the light [m]
  double from;          ///< distance from the eye where the ray enters the medium [m]
  double light_height;  ///< of the light over the medium's top [m]; 0 where it is in the medium
  double psi_start;     ///< π − α at the eye, or ψ at `from` [rad]
  double psi_end;  ///< ψ of the first surface or of where the ray leaves the medium; 0 where it does neither
  double phi_d;    ///< psi_start − psi_end [rad], the range of φ; 0 where nothing lies in the medium

  /// ψ at the fraction s ∈ [0, 1] of the range of φ.
  double psi(double s) const { return psi_end + (1.0 - s) * phi_d; }

  /// The last point in the medium, or infinity, in each axis that the ray moves along.
  /// @param eye relative to the light [m], as is the point
  glm::dvec3 end(const glm::dvec3& eye) const;
};

/// @param eye            relative to the light [m]
/// @param direction      unit direction through the pixel centre
/// @param right          the camera's right: where a ray straight at or away from the light is moved to
/// @param distance       of the first hit along the ray [m]; 0 for none
/// @param smallest_alpha [rad], a quarter of a pixel: a ray nearer to the light is evaluated there
/// @param top            height of the medium's top over the light [m]; none for a medium without a top
ViewRay make_view_ray(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& right,
                      double distance, double smallest_alpha, std::optional<double> top = {});

}  // namespace airlight::reference
