// What a lamp's light adds at a point of a view ray, whatever the lamp and the medium: for the integrals that sum over points. GLSL
// only. (A sun's is in sun.glsl.)
#include "frame/light_colour.glsl"
#include "media/medium_ray.glsl"
#include "media/reach.glsl"

layout(constant_id = 12) const uint k_reach = 0;  // reach.glsl
layout(constant_id = 13) const uint k_light_textured = 0;
layout(binding = k_light_texture_unit) uniform sampler2D light_texture;

// Steps that half a turn has at most for what a light sends in different directions.
const float k_most_texture_steps = 1024.0;

// Half a row of the light's texture, if it has one.
float half_texture_row() { return k_pi / min(2.0 * float(textureSize(light_texture, 0).y), k_most_texture_steps); }

// What a lamp that is alike in all directions, and without end, contributes at φ.
vec3 integrand_at(LayerRay ray, float phi) {
  return k_layer == k_layer_entered ? layer_integrand(space, light, medium, k_phase, ray, phi)
                                    : airlight_integrand(space, medium, k_phase, ray.complement, phi);
}

// What the light sends along the light ray at φ to the view ray, relative to its intensity.
vec3 colour_at(LayerRay ray, float phi) {
  float share = reach_share(space, light, k_reach, ray, phi);
  if (k_light_textured == 0u) return vec3(share);
  return share * light_colour(light_texture, sine(phi) * ray.outward - cosine(phi) * space.axis);
}

// A lit part of the ray on which the integrand is smooth; the light's colour in its middle.
vec3 integrate_short(LayerRay ray, float from, float to) {
  vec3 part = k_layer == k_layer_entered ? integrate_layer_cell(space, light, medium, k_phase, ray, from, to)
                                         : integrate_cell(space, medium, k_phase, ray.complement, from, to);
  return part * colour_at(ray, 0.5 * (from + to));
}

// How many parts a stretch of φ is cut into so that two nodes serve each where extinction and phase function are not rough; a texture's
// columns meet at its poles.
float parts_of(float width) {
  float longest = 0.25;
  if (k_light_textured != 0u) longest = min(0.0625, half_texture_row());
  return ceil(max(width, 0.0) / longest);
}

// A lit part of the ray, in so many equal ones.
vec3 integrate_parts(LayerRay ray, float from, float to) {
  float count = parts_of(to - from);
  float width = (to - from) / max(count, 1.0);
  vec3 sum = vec3(0.0);
  for (float i = 0.0; i < count; ++i) sum += integrate_short(ray, from + i * width, from + (i + 1.0) * width);
  return sum;
}

// A lit part of the ray, in steps that follow the integrand, and where the light is not alike in all directions, or ends, no longer than
// equal cells of half a turn would be, nor than half a texel of latitude.
vec3 integrate_lit(LayerRay ray, float from, float to, float cells) {
  vec3 sum = vec3(0.0);
  int most = k_layer == k_layer_entered ? k_most_layer_steps : k_most_steps;
  float longest = k_pi;
  if (k_light_textured != 0u || k_reach != 0u) {
    longest = k_pi / min(cells, k_most_texture_steps);
    if (k_light_textured != 0u) longest = min(longest, half_texture_row());
    most += int(k_most_texture_steps);
  }
  for (int i = 0; i < most && from < to; ++i) {
    float smooth_step = k_layer == k_layer_entered ? smooth_layer_length(space, light, medium, k_phase, ray, from)
                                                   : smooth_length(space, medium, k_phase, ray.complement, from);
    float next = min(to, from + min(longest, smooth_step));
    sum += integrate_short(ray, from, next);
    from = next;
  }
  return sum;
}
