#version 450
#extension GL_GOOGLE_include_directive : require
#include "viewer/tone_map.glsl"

// A frame's radiance as a screen shows colours, or how it differs from another one's.
layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D other_radiance;
layout(constant_id = 0) const uint k_difference = 0;
layout(constant_id = 1) const uint k_tone_map = 0;
// What it is multiplied by [m² sr/W]: the exposure, or what makes the largest difference shown 1.
layout(location = 0) uniform float brightness;
layout(location = 0) out vec4 colour;

vec3 srgb_of(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(max(c, vec3(1e-8)), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

// Red where it is brighter than the other, blue where it is darker.
vec3 difference_colour(float difference) {
  float depth = clamp(abs(difference), 0.0, 1.0);
  return mix(vec3(1.0), difference > 0.0 ? vec3(0.7, 0.0, 0.0) : vec3(0.0, 0.1, 0.7), depth);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 shown = texelFetch(radiance, pixel, 0).rgb;
  if (k_difference != 0u) {
    vec3 other = texelFetch(other_radiance, pixel, 0).rgb;
    colour = vec4(difference_colour(brightness * dot(shown - other, vec3(1.0 / 3.0))), 1.0);
  } else {
    colour = vec4(srgb_of(tone_mapped(k_tone_map, brightness * shown)), 1.0);
  }
}
