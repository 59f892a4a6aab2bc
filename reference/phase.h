#pragma once

#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace airlight::reference {

/// A phase function: the fraction of the scattered radiance that leaves per unit solid angle [1/sr],
/// normalised so that its integral over the sphere is 1.
///
/// Isotropic: 1/4π. Rayleigh: 3/(16π) (1 + cos²θ), Chandrasekhar, Radiative Transfer (1960), section 3.
/// Henyey-Greenstein: Diffuse radiation in the galaxy (1941), Eq. 2. Hoffman-Preetham: a weighted mean of
/// the last two, Real-time light-atmosphere interactions for outdoor scenes (2003), each normalised on its
/// own.
/// @param cos_theta cosine of the scattering angle, between the directions of travel before and after
inline double phase(const scene::Medium& medium, double cos_theta) {
  const auto rayleigh = [&] { return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cos_theta * cos_theta); };
  const auto henyey_greenstein = [&] {
    const auto g = static_cast<double>(medium.g);
    // 1 + g² − 2g cos θ, written as a sum of terms that keep their digits where the lobe is sharp.
    const double base = g >= 0.0 ? (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cos_theta)
                                 : (1.0 + g) * (1.0 + g) - 2.0 * g * (1.0 + cos_theta);
    return (1.0 - g * g) / (4.0 * std::numbers::pi * base * std::sqrt(base));
  };
  switch (medium.phase) {
    case scene::PhaseFunction::isotropic:
      break;
    case scene::PhaseFunction::rayleigh:
      return rayleigh();
    case scene::PhaseFunction::henyey_greenstein:
      return henyey_greenstein();
    case scene::PhaseFunction::hoffman_preetham: {
      const auto weight = static_cast<double>(medium.rayleigh_weight);
      return weight * rayleigh() + (1.0 - weight) * henyey_greenstein();
    }
  }
  return 0.25 / std::numbers::pi;
}

}  // namespace airlight::reference
