#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/epipolar_lines.glsl"
#include "frame/ray_list.glsl"
#include "frame/seen_surface.glsl"

// Where each listed ray passes through the image, and what it hits, from the triangle that the pixel there sees.
layout(binding = k_ray_members_unit) uniform usamplerBuffer members;
layout(location = 0) out vec2 place;
layout(location = 1) out vec4 surface;

void main() {
  uint ray_number = ray_of_texel(uvec2(gl_FragCoord.xy));
  place = vec2(0.0);
  surface = vec4(0.0);
  if (ray_number < rays.count) {
    uint member = texelFetch(members, int(ray_number)).r;
    uint first_pixel = rays.slices * rays.samples;
    ivec2 size = textureSize(triangle_plus_one, 0);
    if (member < first_pixel) {
      EpipolarLine line = slice_line(epipolar_lines(camera, light.axis), member / rays.samples, rays.slices);
      place = sample_place(line, float(member % rays.samples), rays.samples);
    } else {
      uint pixel = member - first_pixel;
      place = vec2(pixel % uint(size.x), pixel / uint(size.x)) + 0.5;
    }
    surface = seen_surface(clamp(ivec2(place), ivec2(0), size - 1), view_ray(camera, place));
  }
}
