#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/samples_around.glsl"
#include "frame/list_rays.glsl"

// Lists the pixels that no sample around them serves, and those next to the epipole, about which airlight may have its peak within a pixel.
// 4 × 4 pixels an invocation.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_sample_depths_unit) uniform sampler2D sample_depths;  // sample_depths.frag

const float k_peak_width = 2.0;  // [pixels]

void main() {
  uvec2 size = uvec2(textureSize(surface_image, 0));
  uvec2 squares = (size + 3u) / 4u;
  uvec2 square = gl_GlobalInvocationID.xy;
  if (square.x >= squares.x || square.y >= squares.y) return;
  uint slices = rays.slices;
  uint samples = rays.samples;
  uint listed = 0u;
  for (uint i = 0u; i < 16u; ++i) {
    uvec2 pixel = 4u * square + uvec2(i & 3u, i >> 2);
    if (pixel.x < size.x && pixel.y < size.y) {
      SamplesAround around = samples_around(slices, samples, vec2(pixel) + 0.5, texelFetch(surface_image, ivec2(pixel), 0));
      bool is_served = around.from_epipole > k_peak_width;
      bool has_alike = false;
      for (uint j = 0u; j < 4u; ++j) {
        if (is_alike(around, j, texelFetch(sample_depths, around.texels[j], 0).r)) has_alike = true;
      }
      if (!is_served || !has_alike) listed |= 1u << i;
    }
  }

  uint ray = take_rays(uint(bitCount(listed)));
  uint first_pixel = slices * samples;
  groups[(first_pixel >> 4) + square.y * squares.x + square.x] = RayGroup(ray, listed);
  while (listed != 0u) {
    uint i = uint(findLSB(listed));
    uvec2 pixel = 4u * square + uvec2(i & 3u, i >> 2);
    members[ray] = first_pixel + pixel.y * size.x + pixel.x;
    listed &= listed - 1u;
    ++ray;
  }
}
