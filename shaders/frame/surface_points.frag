#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "frame/surface_point.glsl"
#include "frame/occlusion.glsl"

// The point that each pixel shades, relative to the light, under a sun to the eye; and whether the side that is seen of its surface
// can be lit at all: a surface whose plane parts eye and light is dark, and no one need ask what else hides it.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions
// What positions are relative to, world space [m], rounded to float, and what the rounding left.
layout(location = 0) uniform vec3 origin_high;
layout(location = 1) uniform vec3 origin_low;
layout(location = 0) out vec4 point;  // w: 1; 0 where the surface's plane parts eye and light; −1 where no surface is seen

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint seen = texelFetch(triangle_plus_one, pixel, 0).r;
  point = vec4(0.0, 0.0, 0.0, -1.0);
  if (seen != 0u) {
    uvec3 corners = texelFetch(triangles, int(seen) - 1).xyz;
    vec3 world_a = texelFetch(positions, int(corners.x)).xyz;
    vec3 world_b = texelFetch(positions, int(corners.y)).xyz;
    vec3 world_c = texelFetch(positions, int(corners.z)).xyz;
    vec3 weights = surface_weights(view_ray(camera, vec2(pixel) + 0.5), eye_relative(camera, world_a),
                                   eye_relative(camera, world_b), eye_relative(camera, world_c));
    vec3 a = relative_to(origin_high, origin_low, world_a);
    vec3 b = relative_to(origin_high, origin_low, world_b);
    vec3 c = relative_to(origin_high, origin_low, world_c);
    LightRays rays = LightRays(-light.from_eye, light.is_near == 0.0);
    vec3 eye = -light.is_near * light.from_eye;
    point.xyz = weighted(weights, a, b, c);
    point.w = parts_eye_from_light(rays, a, b, c, eye) ? 0.0 : 1.0;
  }
}
