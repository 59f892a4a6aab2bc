// An image and a coarser one of the same view: both are centred, and as high.
#ifndef AIRLIGHT_COARSE_IMAGE_GLSL
#define AIRLIGHT_COARSE_IMAGE_GLSL
#include "shared.glsl"

// Where a place of one image, in pixels from its top left corner, lies in another. The same place where the sizes are the same.
FUNCTION vec2 place_in_image(vec2 place, vec2 size, vec2 other_size) {
  return 0.5f * other_size + (place - 0.5f * size) * (other_size.y / size.y);
}

#endif
