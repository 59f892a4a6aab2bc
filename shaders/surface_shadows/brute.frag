#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/occluders.glsl"

// Asks the predicate of every triangle.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_surface_unit) uniform sampler2D surface_points;
layout(location = 0) uniform uint triangle_count;
layout(location = 1) uniform float scale;
layout(location = 0) out float visibility;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 point = texelFetch(surface_points, pixel, 0);
  visibility = 0.0;
  if (point.w > 0.0) {
    uint own_plane = plane_of(texelFetch(triangle_plus_one, pixel, 0).r - 1u);
    visibility = any_hides_surface(light_rays(), triangle_count, scale * point.xyz, own_plane) ? 0.0 : 1.0;
  }
}
