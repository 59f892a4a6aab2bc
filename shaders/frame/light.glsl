// One light of a view, as the shaders see it.
#ifndef AIRLIGHT_LIGHT_GLSL
#define AIRLIGHT_LIGHT_GLSL
#include "shared.glsl"

// A uniform block (std140), written once a light by frame/blocks.cpp.
struct LightBlock {
  vec3 from_eye;          // light − eye, world axes [m]
  float near;             // depth [m] below which the shadow map no longer orders surfaces
  vec3 intensity;         // radiant intensity [W/sr]
  float shadow_map_size;  // side of a cube face [texels]
};

#endif
