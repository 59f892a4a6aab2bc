#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/medium_ray.glsl"
#include "frame/ray_place.glsl"
#include "frame/shadow_of_air.glsl"
#include "media/march.glsl"

// By look-ups of the shadow map.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) out vec4 airlight;

vec3 light_along(MediumRay ray, float t, float phi) { return vec3(is_lit(t * ray.direction) ? 1.0 : 0.0); }

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec2 place = ray_place(texel);
  airlight = march_airlight(medium_ray(place, texelFetch(surface_image, texel, 0).w), ivec2(place));
}
