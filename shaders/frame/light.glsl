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
  vec3 cone_axis;         // which way a spot shines, of unit length
  float cone_outer;       // 1 − cosine of its outer half-angle; k_no_cone of what is no spot
  float cone_ramp;        // 1 / (cosine of the inner one − cosine of the outer one); 0 for a step
  float inverse_range;    // 1/range [1/m]; 0 for none
  float unused_0;
  float unused_1;
};

// 1 − cosine of an angle is never as large.
CONST float k_no_cone = 4.0f;

// Towards the light from a point relative to the eye, world axes [m]; of a sun the unit direction.
FUNCTION vec3 to_light(IN(LightBlock) light, IN(vec3) point) { return light.from_eye - light.is_near * point; }

// The height of the light above the plane normal · P = offset, times a positive number; P relative to the eye.
FUNCTION float light_above(IN(LightBlock) light, IN(vec3) normal, float offset) {
  return dot(normal, light.from_eye) - light.is_near * offset;
}

// What a spot radiates in a unit direction from it, relative to its intensity; 1 of what is no spot. 1 − cosine is taken from the
// difference of two unit vectors: a narrow cone's cosine has few digits.
FUNCTION float cone_share(IN(LightBlock) light, IN(vec3) direction) {
  vec3 apart = direction - light.cone_axis;
  float inside = light.cone_outer - 0.5f * dot(apart, apart);
  if (light.cone_ramp == 0.0f) return inside >= 0.0f ? 1.0f : 0.0f;
  float ramp = clamp(inside * light.cone_ramp, 0.0f, 1.0f);
  return ramp * ramp;
}

// What a light's range leaves at the distance r from it [m]; 1 without one.
FUNCTION float range_share(IN(LightBlock) light, float r) {
  float q = r * light.inverse_range;
  return max(1.0f - q * q * q * q, 0.0f);
}

#endif
