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

CONST float k_deepest = 87.0f;  // optical depth from which on e^−depth is no normal number
CONST float k_dark = 40.0f;     // optical depth beyond which steps no longer follow a channel while others are lighter
CONST float k_least_psi = 1e-4f;  // [rad]
CONST int k_most_steps = 128;

FUNCTION float rayleigh_phase(float cosine) { return 3.0f / (16.0f * k_pi) * (1.0f + cosine * cosine); }

// Of the half of the scattering angle. 1 + g² − 2g cos θ is written as a sum of positive terms, which keep their digits at the tip
// of the lobe.
FUNCTION float henyey_greenstein_phase(float g, float half_sine, float half_cosine) {
  float across = g > 0.0f ? half_sine : half_cosine;
  float base = (1.0f - abs(g)) * (1.0f - abs(g)) + 4.0f * abs(g) * across * across;
  return (1.0f - g * g) / (4.0f * k_pi * base * sqrt(base));
}

FUNCTION bool has_lobe(uint kind) { return kind == k_henyey_greenstein || kind == k_hoffman_preetham; }

// Phase function [1/sr] of the scattering angle, 0 where light goes on in its direction, given by sine and cosine of its half. Each
// integrates to 1 over the sphere.
//
// Hoffman-Preetham is what molecules and haze scatter together: Hoffman and Preetham, "Real-time light-atmosphere interactions
// for outdoor scenes", Graphics Programming Methods, 2003. Deviation: their Henyey-Greenstein part has the numerator
// (1 − g)², which integrates to (1 − g)/(1 + g); here it is 1 − g².
FUNCTION float phase_function(uint kind, IN(MediumBlock) medium, float half_sine, float half_cosine) {
  float cosine = (half_cosine - half_sine) * (half_cosine + half_sine);
  if (kind == k_rayleigh) return rayleigh_phase(cosine);
  if (kind == k_henyey_greenstein) return henyey_greenstein_phase(medium.g, half_sine, half_cosine);
  if (kind == k_hoffman_preetham) {
    return (1.0f - medium.rayleigh_weight) * henyey_greenstein_phase(medium.g, half_sine, half_cosine) +
           medium.rayleigh_weight * rayleigh_phase(cosine);
  }
  return 0.25f / k_pi;
}

// e^{−σ_t path} p(α + φ), one channel a component. `path` of the light to the eye [m]. `complement` is π − α, from which the
// scattering angle α + φ is right near π too. 0 where single precision has no such number. GLSL lets exp(−x) err by 3 + 2x ulp,
// which is at most 4e-7 of the integrand without fog.
FUNCTION vec3 integrand_of_path(IN(MediumBlock) medium, uint kind, float path, Angle complement, Angle phi) {
  vec3 depth = medium.sigma_t * path;
  vec3 transmittance = exp(-min(depth, vec3(k_deepest)));
  Angle half_from_back = 0.5f * max(complement - phi, Angle(0.0f));
  float phase = phase_function(kind, medium, cosine(half_from_back), sine_of_quarter(half_from_back));
  return vec3(depth.x < k_deepest ? transmittance.x : 0.0f, depth.y < k_deepest ? transmittance.y : 0.0f,
              depth.z < k_deepest ? transmittance.z : 0.0f) *
         phase;
}

// The same where eye, light and all between are in the medium: the path is t + r, infinite from α + φ = π on.
FUNCTION vec3 airlight_integrand(IN(EpipolarBlock) space, IN(MediumBlock) medium, uint kind, Angle complement, Angle phi) {
  return integrand_of_path(medium, kind, path_length(space, complement, phi), complement, phi);
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

// The largest extinction coefficient of a channel that is not dark yet after so long a path, or else the least of all [1/m].
FUNCTION float steepest_channel(IN(MediumBlock) medium, float path) {
  vec3 sigma = medium.sigma_t;
  float least = min(sigma.x, min(sigma.y, sigma.z));
  return max(max(sigma.x * path < k_dark ? sigma.x : least, sigma.y * path < k_dark ? sigma.y : least),
             sigma.z * path < k_dark ? sigma.z : least);
}

// How far along ψ = π − α − φ a lobe, which is 1 − |g| wide, changes little: that, or the distance from its tip.
FUNCTION float scale_of_lobe(IN(MediumBlock) medium, float psi) {
  float from_tip = medium.g > 0.0f ? k_pi - psi : psi;
  float width = 1.0f - abs(medium.g);
  return sqrt(from_tip * from_tip + width * width);
}

// How far outwards from φ the two-point rule follows the integrand, which is smooth on every scale but three: the optical depth
// changes, by `growth` along φ; ψ = π − α − φ falls to 0, where it is infinite; and a lobe is 1 − |g| wide. What lies within
// k_least_psi of ψ = 0, or a hundredth of a ray, is one step.
FUNCTION Angle smooth_length_by_growth(IN(MediumBlock) medium, uint kind, Angle complement, Angle phi, float growth) {
  float psi = max(float(complement - phi), 1e-8f);
  float size = min(0.25f * psi, 0.5f / max(growth, 1e-9f));
  if (has_lobe(kind)) size = min(size, 0.2f * scale_of_lobe(medium, psi));
  return Angle(psi < min(k_least_psi, 0.01f * float(complement)) ? psi : size);
}

// How far outwards from φ four nodes of Gauss and Legendre follow the integrand to about 1e-5 of it. By the same scales: a panel
// spans an optical depth of at most 3, ψ growing as its inverse falls; ends where ψ is still so large that the pole at ψ = 0 lies
// outside an ellipse about the panel that takes the rule's error to that, and so do a lobe's poles at cos(α + φ) = (1 + g²) / 2g,
// −ln|g| beside its tip (docs/method.md).
CONST float k_panel_depth = 3.0f;
CONST float k_panel_psi = 0.6f;
CONST float k_panel_lobe = 0.75f;
CONST float k_longest_panel = 1.2f;  // of Rayleigh's function, which turns with 2φ

FUNCTION Angle panel_length_by_growth(IN(MediumBlock) medium, uint kind, Angle complement, Angle phi, float growth) {
  float psi = max(float(complement - phi), 1e-8f);
  float size = min(min(k_panel_psi * psi, psi / (1.0f + psi * growth / k_panel_depth)), k_longest_panel);
  if (has_lobe(kind)) size = min(size, k_panel_lobe * scale_of_lobe(medium, psi));
  return Angle(psi < min(k_least_psi, 0.01f * float(complement)) ? psi : size);
}

// How far outwards from φ a straight line follows the integrand, to 3e-3 in the mean: its second derivative, which for the depth is
// g² + dg/dφ with g = growth, is small against the inverse square of that length.
CONST float k_straight = 0.25f;

FUNCTION Angle straight_length_by_growth(IN(MediumBlock) medium, uint kind, Angle complement, Angle phi, float growth) {
  float psi = max(float(complement - phi), 1e-8f);
  float size = k_straight / sqrt(growth * growth + 2.0f * growth / psi + 1e-12f);
  if (kind == k_rayleigh || kind == k_hoffman_preetham) size = min(size, k_straight);
  if (has_lobe(kind)) size = min(size, 0.5f * k_straight * scale_of_lobe(medium, psi));
  return Angle(size);
}

// By how much the depth grows along φ where it is that of t + r, which grows as cot(ψ/2); `sigma`: the extinction coefficient [1/m].
FUNCTION float depth_growth(IN(EpipolarBlock) space, float sigma, Angle complement, Angle phi) {
  float half_sine = sine_of_quarter(Angle(0.5f * max(float(complement - phi), 1e-8f)));
  return 0.5f * sigma * space.distance * sine(complement) / (half_sine * half_sine);
}

FUNCTION Angle smooth_length(IN(EpipolarBlock) space, IN(MediumBlock) medium, uint kind, Angle complement, Angle phi) {
  float sigma = steepest_channel(medium, path_length(space, complement, phi));
  return smooth_length_by_growth(medium, kind, complement, phi, depth_growth(space, sigma, complement, phi));
}

// ∫ airlight_integrand dφ over an interval of any length, in steps that follow it.
FUNCTION vec3 integrate_run(IN(EpipolarBlock) space, IN(MediumBlock) medium, uint kind, Angle complement, Angle from, Angle to) {
  vec3 sum = vec3(0.0f);
  for (int i = 0; i < k_most_steps && from < to; ++i) {
    Angle next = min(to, from + smooth_length(space, medium, kind, complement, from));
    sum += integrate_cell(space, medium, kind, complement, from, next);
    from = next;
  }
  return sum;
}

// What turns the integral over φ into radiance: σ_s I / (D sin α).
FUNCTION vec3 airlight_scale(IN(EpipolarBlock) space, IN(LightBlock) light, IN(MediumBlock) medium, float sin_alpha) {
  return medium.sigma_s * light.intensity / (space.distance * sin_alpha);
}

#endif
