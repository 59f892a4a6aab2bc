// Airlight by look-ups along each view ray: a step counts with the share of its light that arrives at one point of it, mostly all
// or none. The light of a lamp's step is the integrand in φ at its middle times its length in φ, in which 1/r² has gone; steps
// that are wide in φ are cut, and with k_rough, where the integrand may change within any, all are. A sun's step has a closed form.
// GLSL only.
#include "media/medium_ray.glsl"
#include "media/lamp.glsl"
#include "media/march_steps.glsl"
#include "media/sun.glsl"

layout(constant_id = 9) const uint k_rough = 0;
layout(constant_id = 18) const uint k_sun = 0;
layout(constant_id = 19) const uint k_by_angle = 0;  // a lamp's steps are equally long in φ, not in t
layout(constant_id = 20) const uint k_jitter = 0;    // media/march.h
const uint k_off = 0u;
const uint k_gathered = 2u;
// The number of steps; how far the scene reaches from the eye, a float's bits [m]; the first step of this pass, and the first of the next.
layout(location = 0) uniform uvec4 march;

// What is looked up: the share of the light, RGB, that reaches the point of a ray at the distance t [m], where φ is `phi`.
vec3 light_along(MediumRay ray, float t, float phi);

// [rad]; steps of a march of 32 or more by angle are narrower.
const float k_wide = 0.1;

vec3 sun_airlight(MediumRay ray, float offset) {
  SunRay sun = sun_ray(medium, light, ray.direction, ray.distance);
  MarchSteps steps = march_steps(sun.entry, sun.exit, uintBitsToFloat(march.y), float(march.x));
  vec3 integral = vec3(0.0);
  float from = march.z == 0u ? sun.entry : place_of_step(steps, float(march.z));
  for (uint i = march.z; i < march.w; ++i) {
    float to = place_of_step(steps, float(i + 1u));
    float at = place_of_step(steps, float(i) + offset);
    vec3 share = light_along(ray, at, phi_at(space, ray.angle, at));
    if (share != vec3(0.0)) integral += share * integrate_sun_run(medium, sun, from, to);
    from = to;
  }
  return sun_scale(light, medium, k_phase, ray.alpha) * integral;
}

// A lit step.
vec3 integrate_step(LayerRay ray, float from, float to) {
  if (k_rough != 0u) return integrate_lit(ray, from, to, float(march.x));
  float middle = 0.5 * (from + to);
  if (to - from < k_wide) return (to - from) * integrand_at(ray, middle) * colour_at(ray, middle);
  return integrate_parts(ray, from, to);
}

vec3 lamp_airlight(MediumRay ray, float offset) {
  LayerRay view = in_plane(ray);
  LitPart part = part_in_reach(space, light, k_reach, view, ray.phi_start, ray.phi_end);
  MarchSteps steps;
  if (k_by_angle == 0u) {
    float from = part.from == ray.phi_start ? ray.entry : layer_distance(space, view, part.from);
    float to = part.to == ray.phi_end ? ray.distance : layer_distance(space, view, part.to);
    steps = march_steps(from, to, uintBitsToFloat(march.y), float(march.x));
  }
  vec3 sum = vec3(0.0);
  float from = part.from;
  if (march.z != 0u) {
    if (k_by_angle != 0u) {
      from = mix(part.from, part.to, float(march.z) / float(march.x));
    } else {
      from = clamp(phi_at(space, ray.angle, place_of_step(steps, float(march.z))), part.from, part.to);
    }
  }
  uint end = part.from < part.to ? march.w : march.z;
  for (uint i = march.z; i < end; ++i) {
    float to = part.to;
    float at;
    float phi;
    if (k_by_angle != 0u) {
      to = mix(part.from, part.to, float(i + 1u) / float(march.x));
      phi = mix(from, to, offset);
      at = layer_distance(space, view, phi);
    } else {
      if (i + 1u < march.x) to = clamp(phi_at(space, ray.angle, place_of_step(steps, float(i + 1u))), from, part.to);
      at = place_of_step(steps, float(i) + offset);
      phi = phi_at(space, ray.angle, at);
    }
    vec3 share = light_along(ray, at, phi);
    if (share != vec3(0.0)) sum += share * integrate_step(view, from, to);
    from = to;
  }
  return airlight_scale(space, light, medium, ray.angle.sine) * sum;
}

// A ray's airlight, as much as this pass adds, and what it was multiplied by: what is gathered is smooth where a lamp is seen, where
// airlight grows as 1/sin α.
vec4 march_airlight(MediumRay ray, ivec2 pixel) {
  float offset = k_jitter != k_off ? interleaved_offset(pixel) : 0.5;
  vec3 radiance = k_sun != 0u ? sun_airlight(ray, offset) : lamp_airlight(ray, offset);
  float flattening = 1.0;
  if (k_sun == 0u) flattening = ray.angle.sine;
  if (k_jitter != k_gathered) flattening = 1.0;
  return vec4(flattening * radiance, march.z == 0u ? flattening : 0.0);
}
