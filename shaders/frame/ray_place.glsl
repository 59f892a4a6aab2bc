// For which view rays a method is asked: those of the image's pixels, or those of a list (frame/epipolar_samples.h). GLSL only.
#include "bindings.glsl"

layout(constant_id = 22) const uint k_listed = 0;
layout(binding = k_places_unit) uniform sampler2D ray_places;

// Where the view ray of a texel passes through the image, in pixels from its top left corner.
vec2 ray_place(ivec2 texel) {
  if (k_listed != 0u) return texelFetch(ray_places, texel, 0).xy;
  return vec2(texel) + 0.5;
}
