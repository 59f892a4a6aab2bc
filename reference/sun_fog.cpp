#include "reference/sun_fog.h"

#include <algorithm>
#include <cmath>

#include "reference/phase.h"

namespace airlight::reference {

SunFog::SunFog(const SunRay& ray, const scene::Medium& medium, const glm::dvec3& irradiance)
    : ray_(ray),
      scattered_(glm::dvec3(medium.sigma_s) * phase(medium, ray.cos_alpha) * irradiance),
      sigma_t_(glm::dvec3(medium.sigma_s) + glm::dvec3(medium.sigma_a)) {}

glm::dvec3 SunFog::radiance(double t_from, double t_to) const {
  const double length = t_to - t_from;
  const double nearest = ray_.slope < 0.0 ? t_to : t_from;  // to both ends of the light's path
  const double path = ray_.path + ray_.slope * (nearest - ray_.from);
  glm::dvec3 radiance(0.0);
  for (int channel = 0; channel < 3; ++channel) {
    if (scattered_[channel] == 0.0) continue;
    // ∫ e^{−k x} dx over [0, length], which is (1 − e^{−k length})/k; what is left out by the branch is k²
    // length³/6.
    const double k = sigma_t_[channel] * std::abs(ray_.slope);
    const double depth = k * length;
    const double integral = depth < 1e-9 ? length * (1.0 - 0.5 * depth) : -std::expm1(-depth) / k;
    radiance[channel] = scattered_[channel] * std::exp(-sigma_t_[channel] * path) * integral;
  }
  return radiance;
}

}  // namespace airlight::reference
