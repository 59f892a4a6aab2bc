#ifndef AIRLIGHT_LIGHT_RAYS_GLSL
#define AIRLIGHT_LIGHT_RAYS_GLSL
#include "shared.glsl"

// Where rays of light come from: the origin, or all along `travels`.
struct LightRays {
  vec3 travels;  // unit direction of a sun's light
  bool is_sun;
};

#endif
