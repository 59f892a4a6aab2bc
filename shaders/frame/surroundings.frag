#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/seen_colour.glsl"
#include "frame/uniforms.glsl"

// What the surroundings add to an image, whatever its lights: constant radiance that surfaces reflect, and what is seen where none
// is; both through the medium. Neither is scattered by it.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) uniform vec3 ambient;     // [W/(m² sr)]
layout(location = 1) uniform vec3 background;  // the same
layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint seen = texelFetch(triangle_plus_one, pixel, 0).r;
  float distance = seen == 0u ? k_endless : texelFetch(surface_image, pixel, 0).w;
  vec3 from = background;
  if (seen != 0u) from = seen_colour(pixel, seen) * ambient;
  vec2 part = part_in_medium(medium, view_ray(camera, vec2(pixel) + 0.5).y, distance);
  radiance = vec4(from * exp(-medium.sigma_t * max(part.y - part.x, 0.0)), 1.0);
}
