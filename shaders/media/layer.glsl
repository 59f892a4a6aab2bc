// The integrand of a lamp's airlight in a layer of fog, where eye or lamp may lie above it: of the paths from lamp to point and from
// point to eye counts what lies in the layer (docs/method.md). The light's part depends on θ too, so it takes the ray itself.
#ifndef AIRLIGHT_LAYER_GLSL
#define AIRLIGHT_LAYER_GLSL
#include "media/medium.glsl"

// There is no layer; or eye and lamp lie in it, so that all light rays to what is seen do, or the light is a sun; or eye or lamp lies
// above it.
CONST uint k_no_layer = 0u;
CONST uint k_layer_around = 1u;
CONST uint k_layer_entered = 2u;

CONST int k_most_layer_steps = 256;
CONST float k_farthest_in_layer = 1e15f;  // [m]; its square is still a number

// A view ray in the layer.
struct LayerRay {
  vec3 direction;
  vec3 outward;      // at right angles to the axis, in the half-plane of the ray
  Angle alpha;
  Angle complement;  // π − α, with all its digits where it is small
  float entry;       // where it enters the layer [m]
};

// sin(α + φ).
FUNCTION float sine_of_scattering(IN(LayerRay) ray, Angle phi) {
  Angle psi = max(ray.complement - phi, Angle(0.0f));
  return sine_of_quarter(float(psi) > 0.5f * k_pi ? ray.alpha + phi : psi);
}

// The distance of the ray's point at φ from the eye [m].
FUNCTION float layer_distance(IN(EpipolarBlock) space, IN(LayerRay) ray, Angle phi) {
  return min(space.distance * sine(phi) / max(sine_of_scattering(ray, phi), 1e-30f), k_farthest_in_layer);
}

FUNCTION vec3 layer_integrand(IN(EpipolarBlock) space, IN(LightBlock) light, IN(MediumBlock) medium, uint kind,
                              IN(LayerRay) ray, Angle phi) {
  float t = layer_distance(space, ray, phi);
  float path = max(t - ray.entry, 0.0f) + light_path(medium, light, t * ray.direction);
  return integrand_of_path(medium, kind, path, ray.complement, phi);
}

// ∫ layer_integrand dφ over a short interval, by the two-point Gauss–Legendre rule.
FUNCTION vec3 integrate_layer_cell(IN(EpipolarBlock) space, IN(LightBlock) light, IN(MediumBlock) medium, uint kind,
                                   IN(LayerRay) ray, Angle from, Angle to) {
  Angle middle = 0.5f * (from + to);
  Angle offset = 0.5f * 0.57735026919f * (to - from);
  return 0.5f * float(to - from) *
         (layer_integrand(space, light, medium, kind, ray, middle - offset) +
          layer_integrand(space, light, medium, kind, ray, middle + offset));
}

// What the integrand's scale is, besides those of a lobe and of ψ: by how much the optical depth grows along φ, and how far in φ
// the light ray is from level. Along the ray the light's path b grows by
//   db/dt = (b/r) dr/dt − w_y r h / (depth + h)²
// with h the lamp's height above the layer, or 0, and depth the point's below it. Where that cancels the growth of the eye's path,
// as in the direction of a far lamp, what is left of the slope grows with φ. And under a lamp above the layer, a light ray that
// comes to be level goes through all of it.
struct LayerScales {
  float growth;
  Angle to_level;
};

FUNCTION LayerScales layer_scales(IN(EpipolarBlock) space, IN(LightBlock) light, IN(MediumBlock) medium, IN(LayerRay) ray, Angle phi) {
  float t = layer_distance(space, ray, phi);
  vec3 point = t * ray.direction;
  vec3 way = to_light(light, point);
  float r = max(length(way), 1e-30f);
  float height = max(light.from_eye.y - medium.top, 0.0f);
  float descent = 1.0f;  // of the light ray, by its length
  float b = light_path(medium, light, point);
  float slope = 1.0f - b / r * (dot(ray.direction, way) / r);
  LayerScales scales;
  scales.to_level = Angle(4.0f * k_pi);
  if (height > 0.0f) {
    float above = max(way.y, height);
    descent = above / r;
    slope -= ray.direction.y / descent * (height / above);
    float change = cosine(phi) * ray.outward.y + sine(phi) * space.axis.y;  // of it, along φ
    scales.to_level = angle_of(descent, abs(change));
  }
  float opening = max(sine_of_scattering(ray, phi), 1e-8f);
  float sigma = steepest_channel(medium, max(t - ray.entry, 0.0f) + b);
  float stretch = sigma * space.distance * sine(ray.complement) / (opening * opening);  // σ dt/dφ
  scales.growth = stretch * abs(slope) + sqrt(stretch) / descent;
  return scales;
}

// smooth_length for that integrand.
FUNCTION Angle smooth_layer_length(IN(EpipolarBlock) space, IN(LightBlock) light, IN(MediumBlock) medium, uint kind,
                                   IN(LayerRay) ray, Angle phi) {
  LayerScales scales = layer_scales(space, light, medium, ray, phi);
  return min(smooth_length_by_growth(medium, kind, ray.complement, phi, scales.growth), 0.25f * scales.to_level);
}

#endif
