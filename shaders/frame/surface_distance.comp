#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/view.glsl"
#include "frame/triangles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = 0) uniform ViewUniform { ViewBlock view; };
layout(binding = 0) uniform usampler2D triangle_plus_one;
layout(binding = 0, r32f) uniform writeonly image2D distance_image;

// Distance along each view ray to the plane of the triangle seen there; 0 where nothing is. Interpolated depth would
// lose digits on large triangles that reach behind the eye.
void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(vec2(pixel), vec2(view.image_width, view.image_height)))) return;
  uint seen = texelFetch(triangle_plus_one, pixel, 0).r;
  float distance = 0.0;
  if (seen != 0u) {
    vec3 a, b, c;
    triangle_corners(view, seen - 1u, a, b, c);
    distance = max(ray_triangle_distance(view_ray(view, vec2(pixel) + 0.5), a, b, c), 1e-30);
  }
  imageStore(distance_image, pixel, vec4(distance));
}
