#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/ray_ends.glsl"
#include "frame/ray_list.glsl"

// The same as phi_range.comp, of listed rays: those of a slice look into one half-plane.
layout(local_size_x = 64) in;
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_places_unit) uniform sampler2D ray_places;

const uint k_rays = 32u;

void main() {
  RayEnds ends = RayEnds(0u, 0.0);
  uint end = min((gl_GlobalInvocationID.x + 1u) * k_rays, rays.count);
  for (uint ray = gl_GlobalInvocationID.x * k_rays; ray < end; ++ray) {
    ivec2 texel = texel_of_ray(ray);
    see_end(ends, texelFetch(ray_places, texel, 0).xy, texelFetch(surface_image, texel, 0).w);
  }
  note_ends(ends);
}
