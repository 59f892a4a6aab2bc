// A light textured by direction: scene/light_texture.h has the convention.
#ifndef AIRLIGHT_LIGHT_TEXTURE_GLSL
#define AIRLIGHT_LIGHT_TEXTURE_GLSL
#include "shared.glsl"

// Where the direction (x, y, z) from the light lies in its texture, each side from 0 to 1. `longitude` is the angle of (x, z) from
// the z axis, `latitude` that of y from the plane of the other two.
FUNCTION vec2 light_texture_place(float longitude, float latitude) {
  return vec2(0.5f - longitude * 0.159154943f, 0.5f - latitude * 0.318309886f);
}

#endif
