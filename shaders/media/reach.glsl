// Where a spot's cone and a light's range reach along a view ray, and what they leave there.
#ifndef AIRLIGHT_REACH_GLSL
#define AIRLIGHT_REACH_GLSL
#include "media/layer.glsl"

// What a light has; one is added to the other.
CONST uint k_reach_of_cone = 1u;
CONST uint k_reach_of_range = 2u;

// The part of a view ray that the light reaches, none of it unless from < to, and the part of that which lies within a spot's inner
// cone, or is all.
struct LitPart {
  Angle from;
  Angle to;
  Angle inner_from;
  Angle inner_to;
};

// In the half-plane of a view ray a light ray is sin φ · outward − cos φ · l, and its angle from the spot's axis c has the cosine
//   A sin φ − B cos φ = m cos(φ − φ₀),   A = outward · c,   B = l · c,   m² = A² + B² = 1 − n²,
// n being the part of c at right angles to the plane. A cone of half-angle γ ≤ π/2 is cut where that is cos γ, at φ₀ ± δ,
//   tan δ = √(m² − cos² γ) / cos γ = √(sin² γ − n²) / cos γ,
// which has its digits in a narrow cone too. As δ ≤ π/2 and φ ∈ [0, π], what is lit is one interval, with φ₀ taken from
// [−π/2, 3π/2). `fall`: 1 − cos γ. Returns δ, below 0 where the plane misses the cone.
FUNCTION Angle half_width_of_cone(float fall, float off_plane) {
  float square = fall * (2.0f - fall) - off_plane * off_plane;
  return square < 0.0f ? Angle(-1.0f) : angle_of(sqrt(square), 1.0f - fall);
}

// `part`: what the view ray has.
FUNCTION LitPart part_in_reach(IN(EpipolarBlock) space, IN(LightBlock) light, uint reach, IN(LayerRay) ray, Angle from, Angle to) {
  LitPart part;
  part.from = from;
  part.to = to;
  part.inner_from = from;
  part.inner_to = to;
  if ((reach & k_reach_of_range) != 0u) {
    // r = D sin α / sin ψ is the range where sin ψ = q.
    float q = min(space.distance * sine(ray.complement) * light.inverse_range, 1.0f);
    Angle psi = angle_of(q, sqrt((1.0f - q) * (1.0f + q)));
    part.from = max(part.from, psi - ray.alpha);
    part.to = min(part.to, ray.complement - psi);
  }
  if ((reach & k_reach_of_cone) != 0u) {
    float off_plane = dot(light.cone_axis, cross(space.axis, ray.outward));
    Angle middle = angle_of(dot(light.cone_axis, ray.outward), -dot(light.cone_axis, space.axis));
    if (float(middle) < -0.5f * k_pi) middle = middle + 2.0f * k_half_turn;
    Angle outer = half_width_of_cone(light.cone_outer, off_plane);
    Angle inner = light.cone_ramp == 0.0f ? outer : half_width_of_cone(light.cone_outer - 1.0f / light.cone_ramp, off_plane);
    part.from = max(part.from, middle - outer);
    part.to = min(part.to, middle + outer);
    part.inner_from = middle - inner;
    part.inner_to = middle + inner;
  }
  return part;
}

// What the light's cone and range leave at φ.
FUNCTION float reach_share(IN(EpipolarBlock) space, IN(LightBlock) light, uint reach, IN(LayerRay) ray, Angle phi) {
  float share = 1.0f;
  if ((reach & k_reach_of_cone) != 0u) share *= cone_share(light, sine(phi) * ray.outward - cosine(phi) * space.axis);
  if ((reach & k_reach_of_range) != 0u)
    share *= range_share(light, space.distance * sine(ray.complement) / max(sine_of_scattering(ray, phi), 1e-15f));
  return share;
}

#endif
