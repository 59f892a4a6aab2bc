#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "reference/fog_quadrature.h"
#include "reference/light_shape.h"
#include "reference/light_texture.h"
#include "reference/sun_fog.h"
#include "reference/sun_ray.h"
#include "reference/view_ray.h"
#include "scene/scene.h"

namespace airlight::reference {

/// What runs of a view ray scatter to the eye where they are lit. Keeps its memory from ray to ray.
class RunIntegrals {
 public:
  /// @param light, medium, texture kept by reference; the last is the light's, nullptr for none
  /// @param refinement             of the quadrature, where there is one (`FogQuadrature::refine`)
  RunIntegrals(const scene::Light& light, const scene::Medium& medium, const LightLookup* texture,
               int refinement = 1)
      : light_(light), medium_(medium), refinement_(refinement), shape_(light) {
    if (texture) texture_.emplace(*texture);
  }

  /// N sums over runs of one view ray, RGB [W/(m² sr)].
  /// @param visit void(add): calls add(sum, from, to, weight) with each run, from and to as in
  ///              `ShadowIntervals::Run`, weight a number or RGB
  template <std::size_t N, class Visit>
  std::array<glm::dvec3, N> radiances(const ViewRay& ray, const Visit& visit) {
    if (texture_) texture_->aim(ray);
    if (shape_.is_shaped()) shape_.aim(ray);
    const LightAlongRay* texture = texture_ ? &*texture_ : nullptr;
    const LightShape* shape = shape_.is_shaped() ? &shape_ : nullptr;
    const glm::dvec3 scale = airlight_scale(ray, light_, medium_);
    std::array<glm::dvec3, N> sums = integrate_channels<N>(ray, medium_, scale, [&](FogQuadrature& fog) {
      fog.refine(refinement_);
      std::array<glm::dvec3, N> of_sigma{};
      visit([&](std::size_t sum, double from, double to, const auto& weight) {
        of_sigma[sum] += weight * fog.integral(from, to, texture, shape);
      });
      return of_sigma;
    });
    for (glm::dvec3& sum : sums) sum *= scale;  // docs/method.md (*)
    return sums;
  }

  template <std::size_t N, class Visit>
  std::array<glm::dvec3, N> radiances(const SunRay& ray, const Visit& visit) {
    const SunFog fog(ray, medium_, glm::dvec3(light_.irradiance));
    std::array<glm::dvec3, N> sums{};
    visit([&](std::size_t sum, double from, double to, const auto& weight) {
      sums[sum] += weight * fog.radiance(from, to);
    });
    return sums;
  }

 private:
  const scene::Light& light_;
  const scene::Medium& medium_;
  int refinement_;
  std::optional<LightAlongRay> texture_;
  LightShape shape_;
};

}  // namespace airlight::reference
