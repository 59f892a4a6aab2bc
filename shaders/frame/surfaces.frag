#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/coarse_image.glsl"
#include "frame/seen_surface.glsl"

// What each view ray hits. The image of triangles may be a finer one than the camera's.
layout(location = 0) out vec4 surface;

void main() {
  ivec2 size = textureSize(triangle_plus_one, 0);
  vec2 place = place_in_image(gl_FragCoord.xy, vec2(camera.image_width, camera.image_height), vec2(size));
  vec3 ray = view_ray(camera, vec2(ivec2(gl_FragCoord.xy)) + 0.5);
  surface = seen_surface(clamp(ivec2(place), ivec2(0), size - 1), ray);
}
