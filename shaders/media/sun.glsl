// What a sun's light adds along a view ray, in closed form.
//
// The scattering angle is α all along the ray, and the path by way of a point, from where light enters the medium to the eye, is
// linear in the point's distance. So a lit run from t_0 to t_1 adds (docs/method.md)
//   σ_s E p(α) ∫ e^{−σ_t path(t)} dt = σ_s E p(α) (t_1 − t_0) e^{−min τ} (1 − e^{−x}) / x,   x = |τ(t_1) − τ(t_0)|,
// which has no difference of two large numbers, and no 0/0 where the path does not change, as in the sun's own direction.
#ifndef AIRLIGHT_SUN_GLSL
#define AIRLIGHT_SUN_GLSL
#include "media/medium.glsl"

// A view ray in the light of a sun.
struct SunRay {
  float entry;  // where it enters the medium [m], …
  float exit;   // … and where it ends or leaves it: no more than k_farthest
  float path;   // of the light to the eye by way of the entry, in the medium [m]
  float slope;  // by how much that grows along the ray; it may fall
};

// Where an endless ray ends [m]; times an extinction of 1e6 and a slope of 1e3 it is still a number.
CONST float k_farthest = 1e25f;

// `direction`: of unit length. `length`: of the ray [m].
FUNCTION SunRay sun_ray(IN(MediumBlock) medium, IN(LightBlock) light, IN(vec3) direction, float length) {
  vec2 part = part_in_medium(medium, direction.y, min(length, k_farthest));
  SunRay ray;
  ray.entry = part.x;
  ray.exit = max(part.y, part.x);
  ray.path = 0.0f;
  ray.slope = 1.0f;
  if (is_layer(medium)) {
    ray.path = max(medium.top, 0.0f) / light.from_eye.y;  // a ray from above enters at the top
    ray.slope = 1.0f - direction.y / light.from_eye.y;
  }
  return ray;
}

// (1 − e^{−x}) / x for x ≥ 0, to 1e-6.
FUNCTION float mean_decay(float x) {
  float by_exp = (1.0f - exp(-min(x, k_deepest))) / max(x, 0.3f);
  float by_series = 1.0f - x * (0.5f - x * (0.166666667f - x * (0.0416666667f - x * (0.00833333333f - x * 0.00138888889f))));
  return x > 0.3f ? by_exp : by_series;
}

// ∫ e^{−σ_t path(t)} dt between two places of the ray, one channel a component [m].
FUNCTION vec3 integrate_sun_run(IN(MediumBlock) medium, IN(SunRay) ray, float from, float to) {
  vec3 at_from = medium.sigma_t * (ray.path + ray.slope * (from - ray.entry));
  vec3 change = medium.sigma_t * (ray.slope * (to - from));
  vec3 least = max(at_from + min(change, vec3(0.0f)), vec3(0.0f));
  vec3 decay = exp(-min(least, vec3(k_deepest)));
  vec3 is_left = vec3(least.x < k_deepest ? 1.0f : 0.0f, least.y < k_deepest ? 1.0f : 0.0f, least.z < k_deepest ? 1.0f : 0.0f);
  return (to - from) * is_left * decay * vec3(mean_decay(abs(change.x)), mean_decay(abs(change.y)), mean_decay(abs(change.z)));
}

// What turns that into radiance: σ_s E p(α).
FUNCTION vec3 sun_scale(IN(LightBlock) light, IN(MediumBlock) medium, uint kind, Angle alpha) {
  Angle half_alpha = 0.5f * alpha;
  return medium.sigma_s * light.intensity * phase_function(kind, medium, sine_of_quarter(half_alpha), cosine(half_alpha));
}

#endif
