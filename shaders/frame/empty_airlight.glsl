// How airlight without shadows changes over the image. GLSL only.
#include "frame/uniforms.glsl"

// About what airlight would be without shadows and without its peak (airlight_peak), up to a factor. Of a lamp in thin fog that scatters to
// all sides alike: the angle at the light under which a view ray's part in the medium is seen. Of a sun, with its lobe, but without what
// attenuates its own path. `distance`: along the ray to a surface, 0 for none [m].
float empty_airlight(vec3 ray, float distance) {
  vec2 part = vec2(0.0, distance == 0.0 ? 1e30 : distance);
  if (is_layer(medium)) {
    part = part_in_medium(medium, ray.y, part.y);
    if (part.x >= part.y) part = vec2(0.0);
  }
  float cosine_alpha = dot(light.axis, ray);
  float sine_alpha = max(length(cross(light.axis, ray)), 1e-6);
  if (light.is_near > 0.0) {
    float to_light = 1.0 / light.inverse_distance;
    float angle = angle_of(part.y * sine_alpha, to_light - part.y * cosine_alpha) - angle_of(part.x * sine_alpha, to_light - part.x * cosine_alpha);
    return cosine_alpha > 0.0 ? angle : angle / sine_alpha;
  }
  float sigma = dot(medium.sigma_t, vec3(1.0 / 3.0));
  float depth = sigma * (part.y - part.x);
  float seen = depth < 1e-3 ? part.y - part.x : (1.0 - exp(-min(depth, 80.0))) / sigma;
  float away = 1.0 + medium.g * medium.g - 2.0 * medium.g * cosine_alpha;
  return seen / (away * sqrt(away));
}
