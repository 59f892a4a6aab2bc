#pragma once

#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace airlight::reference {

/// A phase function: the fraction of the scattered radiance that leaves per unit solid angle [1/sr],
/// normalised so that its integral over the sphere is 1.
///
/// Isotropic: 1/4π. Rayleigh: 3/(16π) (1 + cos²θ), Chandrasekhar, Radiative Transfer (1960), section 3.
/// Henyey-Greenstein: Diffuse radiation in the galaxy (1941), Eq. 2.
/// @param cos_theta cosine of the scattering angle, between the directions of travel before and after
/// @param g         mean cosine, for Henyey-Greenstein only
inline double phase(scene::PhaseFunction function, double g, double cos_theta) {
  switch (function) {
    case scene::PhaseFunction::isotropic:
      break;
    case scene::PhaseFunction::rayleigh:
      return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cos_theta * cos_theta);
    case scene::PhaseFunction::henyey_greenstein: {
      // 1 + g² − 2g cos θ, written as a sum of terms that keep their digits where the lobe is sharp.
      const double base = g >= 0.0 ? (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cos_theta)
                                   : (1.0 + g) * (1.0 + g) - 2.0 * g * (1.0 + cos_theta);
      return (1.0 - g * g) / (4.0 * std::numbers::pi * base * std::sqrt(base));
    }
  }
  return 0.25 / std::numbers::pi;
}

}  // namespace airlight::reference
