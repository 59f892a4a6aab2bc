#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/empty_airlight.glsl"
#include "frame/epipolar_lines.glsl"
#include "frame/ray_list.glsl"

// 1/depth of what each epipolar sample sees [1/m], 0 of nothing: of the plane that the pixel there sees; and what airlight would be without
// shadows. A row a slice.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) out vec2 seen;

void main() {
  EpipolarLine line = slice_line(epipolar_lines(camera, light.axis), uint(gl_FragCoord.y), rays.slices);
  vec2 place = sample_place(line, floor(gl_FragCoord.x), rays.samples);
  ivec2 pixel = clamp(ivec2(place), ivec2(0), textureSize(surface_image, 0) - 1);
  vec4 surface = texelFetch(surface_image, pixel, 0);
  vec2 middle = vec2(pixel) + 0.5;
  SeenPlane plane = seen_plane(camera, middle, surface.xyz, surface.w);
  // The plane of what is seen edge-on leads anywhere.
  float inverse_depth = clamp(inverse_depth_at(plane, place - middle), 0.5 * plane.at, 2.0 * plane.at);
  vec3 ray = view_ray(camera, place);
  float distance = inverse_depth > 0.0 ? 1.0 / (inverse_depth * dot(ray, camera.forward)) : 0.0;
  seen = vec2(inverse_depth, empty_airlight(ray, distance));
}
