#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "reference/view_ray.h"
#include "scene/light_texture.h"

namespace airlight::reference {

/// Looks up what a textured light radiates by direction (scene/light_texture.h).
class LightLookup {
 public:
  /// @param texture kept by reference
  explicit LightLookup(const scene::LightTexture& texture);

  /// RGB, relative to the radiant intensity.
  /// @param direction from the light, world axes, of any length
  glm::dvec3 at(const glm::dvec3& direction) const;

 private:
  friend class LightAlongRay;
  const scene::LightTexture& texture_;
  std::vector<glm::dvec2>
      meridians_;                  ///< of texel centres: cosine and sine of their longitude, each plane once
  std::vector<double> parallels_;  ///< of texel centres: sine of their latitude
};

/// The same for the light rays of one view ray, cut where they pass from between four texel centres to
/// between four others: inside each piece the texture is smooth. Keeps its memory from ray to ray.
class LightAlongRay {
 public:
  /// @param lookup kept by reference
  explicit LightAlongRay(const LightLookup& lookup) : lookup_(lookup) {}

  void aim(const ViewRay& ray);

  /// RGB at the angle ψ (view_ray.h).
  glm::dvec3 at(double psi) const { return lookup_.at(direction(psi)); }

  /// The longest interval from ψ on over which the longitude is smooth: it turns the faster the nearer the
  /// light rays come to a pole.
  double smooth_length(double psi) const;

  /// Calls f(from, to) with each piece of [`psi_to`, `psi_from`], in falling order of ψ.
  template <class Function>
  void for_each_piece(double psi_from, double psi_to, const Function& f) const {
    double from = psi_from;
    auto cut = std::upper_bound(cuts_.begin(), cuts_.end(), psi_from, std::greater<>());
    for (; cut != cuts_.end() && *cut > psi_to; ++cut) {
      if (*cut < from) f(from, *cut);
      from = *cut;
    }
    if (psi_to < from) f(from, psi_to);
  }

 private:
  glm::dvec3 direction(double psi) const;

  const LightLookup& lookup_;
  glm::dvec3 w_{0.0}, q_{0.0};  ///< of the view ray
  std::vector<double> cuts_;    ///< ψ, falling
};

}  // namespace airlight::reference
