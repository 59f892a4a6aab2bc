// What the triangles between the light and a point leave of the light. Most let nothing through; what others take is added up as
// −log₂ of the share that is left, in whole numbers, so that the order in which a tree is gone through does not matter.
//
// A triangle that lets nothing through hides what it touches (`hides`); of others, each sheet is counted once (`crosses`).
// GLSL only; after frame/occlusion.glsl.
#include "frame/surface_point.glsl"

layout(binding = k_attenuations_unit) uniform usamplerBuffer attenuations;  // of triangles: frame/scene_buffers.h
layout(constant_id = 34) const uint k_transmits = 0;  // light passes some triangles; else there are no `attenuations`

// scene::Attenuation
const float k_halving = 65536.0;
const uint k_nothing_left = 40u * 65536u;

// In the place of the plane that a point's surface lies in, where it is on none.
const uint k_in_air = 0xffffffffu;

bool is_hidden = false;
uvec3 taken = uvec3(0u);

// Nothing has been met yet.
void begin_point() {
  is_hidden = false;
  taken = uvec3(0u);
}

vec3 light_left() {
  vec3 left = vec3(is_hidden ? 0.0 : 1.0);
  if (k_transmits != 0u && !is_hidden) left = mix(exp2(-vec3(taken) / k_halving), vec3(0.0), equal(taken, uvec3(k_nothing_left)));
  return left;
}

// What a triangle takes of light that falls on it along a unit direction. The triangle's corners may be in any scale.
uvec3 attenuation_along(Occluder triangle, uvec4 attenuation, vec3 direction) {
  uvec3 amount = attenuation.rgb;
  if (attenuation.a != 0u) {
    ScaledTriangle scaled = scaled_triangle(triangle.a, triangle.b, triangle.c);
    float cosine = abs(dot(scaled.normal, direction)) * inversesqrt(max(scaled.area2, 1e-30));
    amount = uvec3(min(vec3(amount) / max(cosine, 1e-9) + 0.5, vec3(k_nothing_left)));
  }
  return amount;
}

// Light passes a triangle on its way to a point.
void pass_through(LightRays rays, Occluder triangle, uvec4 attenuation, vec3 point) {
  vec3 direction = rays.is_sun ? rays.travels : unit_or(point, vec3(0.0));
  taken = min(taken + attenuation_along(triangle, attenuation, direction), uvec3(k_nothing_left));
  is_hidden = taken == uvec3(k_nothing_left);
}

// Asks what a triangle lets through of the light on its way to a point; `is_own` where the point lies in the triangle's plane.
void meet(LightRays rays, Occluder triangle, uint number, vec3 point, bool is_own) {
  if (hides(rays, triangle, point) && !is_own) {
    uvec4 attenuation = uvec4(k_nothing_left);
    if (k_transmits != 0u) attenuation = texelFetch(attenuations, int(number));
    if (attenuation.rgb == uvec3(k_nothing_left)) {
      is_hidden = true;
    } else if (crosses(rays, triangle, point)) {
      pass_through(rays, triangle, attenuation, point);
    }
  }
}

// Whether a surface that lies between the eye and the light, and so is dark, glows with what it lets through.
bool glows(uint number) {
  bool result = false;
  if (k_transmits != 0u) result = texelFetch(attenuations, int(number)).rgb != uvec3(k_nothing_left);
  return result;
}
