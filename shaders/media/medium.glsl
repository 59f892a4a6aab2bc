// The homogeneous medium: phase functions, and the integrand of airlight along a view ray.
//
// Airlight of a point light, single scattering, in epipolar coordinates (docs/method.md):
//   L_s = σ_s I / (D sin α) ∫₀^{φ_d} e^{−σ_t (t + r)} p(α + φ) V(φ) dφ
// Deviation from Wyman 2011, Eq. 4, which leaves the light's own extinction to L_in: here both paths are attenuated.
#ifndef AIRLIGHT_MEDIUM_GLSL
#define AIRLIGHT_MEDIUM_GLSL
#include "epipolar/space.glsl"
#include "frame/light.glsl"
#include "frame/medium.glsl"

CONST uint k_isotropic = 0u;
CONST uint k_rayleigh = 1u;
CONST uint k_henyey_greenstein = 2u;
CONST uint k_hoffman_preetham = 3u;

FUNCTION float rayleigh_phase(float cosine) { return 3.0f / (16.0f * k_pi) * (1.0f + cosine * cosine); }

FUNCTION float henyey_greenstein_phase(float g, float cosine) {
  float base = max(1.0f + g * g - 2.0f * g * cosine, 1e-12f);
  return (1.0f - g * g) / (4.0f * k_pi * base * sqrt(base));
}

// Phase function [1/sr] of the scattering angle's cosine: 1 where light goes on in its direction. Each integrates to 1 over the
// sphere.
//
// Hoffman-Preetham is what molecules and haze scatter together: Hoffman and Preetham, "Real-time light-atmosphere interactions
// for outdoor scenes", Graphics Programming Methods, 2003. Deviation: their Henyey-Greenstein part has the numerator
// (1 − g)², which integrates to (1 − g)/(1 + g); here it is 1 − g².
FUNCTION float phase_function(uint kind, IN(MediumBlock) medium, float cosine) {
  if (kind == k_rayleigh) return rayleigh_phase(cosine);
  if (kind == k_henyey_greenstein) return henyey_greenstein_phase(medium.g, cosine);
  if (kind == k_hoffman_preetham) {
    return (1.0f - medium.rayleigh_weight) * henyey_greenstein_phase(medium.g, cosine) +
           medium.rayleigh_weight * rayleigh_phase(cosine);
  }
  return 0.25f / k_pi;
}

// e^{−σ_t (t + r)} p(α + φ), one channel a component. `complement` is π − α, from which the scattering angle α + φ is
// right near π too. 0 from α + φ = π on, where the path is infinite. GLSL lets exp(−x) err by 3 + 2x ulp, which is at most 4e-7 of
// the integrand without fog.
FUNCTION vec3 airlight_integrand(IN(EpipolarBlock) space, IN(MediumBlock) medium, uint kind, Angle complement, Angle phi) {
  float path = path_length(space, complement, phi);
  return exp(-min(medium.sigma_t * path, vec3(80.0f))) * phase_function(kind, medium, -cosine(complement - phi));
}

// ∫ airlight_integrand dφ over a short interval, by the two-point Gauss–Legendre rule.
FUNCTION vec3 integrate_cell(IN(EpipolarBlock) space, IN(MediumBlock) medium, uint kind, Angle complement, Angle from,
                             Angle to) {
  Angle middle = 0.5f * (from + to);
  Angle offset = 0.5f * 0.57735026919f * (to - from);
  return 0.5f * float(to - from) *
         (airlight_integrand(space, medium, kind, complement, middle - offset) +
          airlight_integrand(space, medium, kind, complement, middle + offset));
}

// What turns the integral over φ into radiance: σ_s I / (D sin α).
FUNCTION vec3 airlight_scale(IN(EpipolarBlock) space, IN(LightBlock) light, IN(MediumBlock) medium, float sin_alpha) {
  return medium.sigma_s * light.intensity / (space.distance * sin_alpha);
}

#endif
