// One light of a view, as the shaders see it.
#ifndef AIRLIGHT_LIGHT_GLSL
#define AIRLIGHT_LIGHT_GLSL
#include "shared.glsl"

// A uniform block (std140), written once a light by frame/blocks.cpp. A light lies at from_eye / is_near from the eye: a point at
// some distance, a sun infinitely far in a direction.
struct LightBlock {
  vec3 from_eye;          // light − eye, world axes [m]; of a sun the unit direction towards it
  float is_near;          // 1; 0 of a sun
  vec3 intensity;         // radiant intensity [W/sr]; of a sun its irradiance [W/m²]
  float shadow_map_size;  // side of the shadow map, or of a face of its cube [texels]
  // Of a shadow cube:
  float near;             // depth [m] below which it no longer orders surfaces
  // Of a shadow map on a plane (shadow_plane.glsl):
  float depth_scale;      // of Z [1/m], …
  float depth_offset;     // … on the way to the depth that is stored
  float half_texel;       // half the larger side of a texel, where light rays cross the plane through the eye [m]; of a cube too
  vec4 image_x;           // where a point of the plane's map lies in its image, from −1 to 1: dot(image.xyz, point) + image.w
  vec4 image_y;
  vec3 axis;              // l, the unit direction from the eye to the light
  float inverse_distance; // 1/D [1/m], 0 of a sun
};

// Towards the light from a point relative to the eye, world axes [m]; of a sun the unit direction.
FUNCTION vec3 to_light(IN(LightBlock) light, IN(vec3) point) { return light.from_eye - light.is_near * point; }

// The height of the light above the plane normal · P = offset, times a positive number; P relative to the eye.
FUNCTION float light_above(IN(LightBlock) light, IN(vec3) normal, float offset) {
  return dot(normal, light.from_eye) - light.is_near * offset;
}

#endif
