#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "reference/shadow_intervals.h"
#include "reference/sun_ray.h"
#include "reference/view_ray.h"
#include "scene/scene.h"

namespace airlight::reference {

/// How far view rays can be in shadow: under a sun, what lies behind the shadow of the scene's box is lit.
/// Keeps its memory from ray to ray.
class Shadowable {
 public:
  /// @param box of the scene, world space [m]
  /// @param eye world space [m]
  /// @param sun unit direction to the light where that is a sun
  Shadowable(const scene::Box& box, const glm::dvec3& eye, const std::optional<glm::dvec3>& sun);

  /// The view ray up to there.
  SunRay part_of(const SunRay& ray);
  const ViewRay& part_of(const ViewRay& ray) const { return ray; }

  /// Calls f(from, to) with what lies beyond (`ShadowIntervals::Run`).
  template <class Function>
  static void for_each_rest(const SunRay& ray, const SunRay& part, const Function& f) {
    if (part.to < ray.to) f(part.to, ray.to);
  }
  template <class Function>
  static void for_each_rest(const ViewRay&, const ViewRay&, const Function&) {}

 private:
  Occluders box_;
  ShadowIntervals shadow_;
};

}  // namespace airlight::reference
