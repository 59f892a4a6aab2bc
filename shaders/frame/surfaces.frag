#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/coarse_image.glsl"
#include "frame/uniforms.glsl"

// What each view ray hits, from the triangle seen there: its normal, turned towards the eye, and the distance to its plane.
// The image of triangles may be a finer one than the camera's. Interpolated depth would lose digits on large triangles that reach behind the eye.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions
layout(location = 0) out vec4 surface;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 size = textureSize(triangle_plus_one, 0);
  vec2 place = place_in_image(gl_FragCoord.xy, vec2(camera.image_width, camera.image_height), vec2(size));
  uint seen = texelFetch(triangle_plus_one, clamp(ivec2(place), ivec2(0), size - 1), 0).r;
  surface = vec4(0.0);
  if (seen != 0u) {
    uvec3 corners = texelFetch(triangles, int(seen) - 1).xyz;
    vec3 a = eye_relative(camera, texelFetch(positions, int(corners.x)).xyz);
    vec3 b = eye_relative(camera, texelFetch(positions, int(corners.y)).xyz);
    vec3 c = eye_relative(camera, texelFetch(positions, int(corners.z)).xyz);
    vec3 ray = view_ray(camera, vec2(pixel) + 0.5);
    // Three corners in line may be seen once they are rasterised.
    vec3 normal = unit_or(cross(b - a, c - a), -ray);
    surface.xyz = dot(normal, ray) > 0.0 ? -normal : normal;
    surface.w = max(ray_triangle_distance(ray, a, b, c), 1e-30);
  }
}
