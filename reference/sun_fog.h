#pragma once

#include <glm/glm.hpp>

#include "reference/sun_ray.h"
#include "scene/scene.h"

namespace airlight::reference {

/// The airlight of a sun along one view ray, in closed form.
class SunFog {
 public:
  /// @param ray        kept by reference
  /// @param irradiance of the sun, RGB [W/m²]
  SunFog(const SunRay& ray, const scene::Medium& medium, const glm::dvec3& irradiance);

  /// What the part [t_from, t_to] of the ray scatters to the eye where it is lit, RGB [W/(m² sr)].
  glm::dvec3 radiance(double t_from, double t_to) const;

 private:
  const SunRay& ray_;
  glm::dvec3 scattered_;  ///< σ_s p E [W/(m³ sr)]
  glm::dvec3 sigma_t_;    ///< [1/m]
};

}  // namespace airlight::reference
