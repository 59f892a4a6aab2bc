#pragma once

#include <optional>

#include <glm/glm.hpp>

namespace airlight::reference {

/// The half-plane of a view ray and the light, which is at l from the eye.
struct LightPlane {
  glm::dvec3 w;      ///< unit direction of the view ray
  glm::dvec3 q;      ///< unit vector in the half-plane across the view ray, away from the light
  double sin_alpha;  ///< α ∈ (0, π): angle at the eye between l and w
  double cos_alpha;
};

/// The smallest distance of α from π [rad]. The airlight is even in π − α, so that a ray at the light's
/// antipode is evaluated here with a relative error of the order of 1e-12; of 1e-6 of the optical depth in a
/// layer, which is not even.
inline constexpr double k_smallest_psi_eye = 1e-6;

/// @param l              unit direction from the eye to the light
/// @param direction      unit direction through the pixel centre
/// @param right          the camera's right: where a ray straight at or away from the light is moved to
/// @param smallest_alpha [rad], a quarter of a pixel: a ray nearer to the light is evaluated there
LightPlane make_light_plane(const glm::dvec3& l, const glm::dvec3& direction, const glm::dvec3& right,
                            double smallest_alpha);

/// A part of a view ray, by the distance from the eye [m].
struct Stretch {
  double from, to;
};

/// What lies in the medium of a view ray; from = to where nothing does.
/// @param eye_y    height of the eye over the medium's top [m]; none for a medium without a top
/// @param w_y      the height that the ray gains by length
/// @param distance of the first hit along the ray [m]; 0 for none
Stretch in_medium(std::optional<double> eye_y, double w_y, double distance);

/// Where a view ray without end goes: infinity in each axis that it moves along.
glm::dvec3 far_end(const glm::dvec3& eye, const glm::dvec3& w);

}  // namespace airlight::reference
