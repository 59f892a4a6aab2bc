// View rays of a list, one a texel, in the place of an image's pixels. GLSL only.
#include "frame/ray_list_block.glsl"

layout(std140, binding = k_rays_block) uniform RayListUniform { RayListBlock rays; };

// Sixteen rays are a square of 4 × 4 texels, so that those that follow one another are shaded together.
ivec2 texel_of_ray(uint ray) {
  uint square = ray >> 4;
  uint squares = rays.width >> 2;
  uvec2 corner = 4u * uvec2(square % squares, square / squares);
  return ivec2(corner + uvec2(ray & 3u, ray >> 2 & 3u));
}

uint ray_of_texel(uvec2 texel) {
  uint square = (texel.y >> 2) * (rays.width >> 2) + (texel.x >> 2);
  return 16u * square + 4u * (texel.y & 3u) + (texel.x & 3u);
}
