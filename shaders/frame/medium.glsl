// The homogeneous medium, all of space or a layer of it, as the shaders see it.
#ifndef AIRLIGHT_MEDIUM_BLOCK_GLSL
#define AIRLIGHT_MEDIUM_BLOCK_GLSL
#include "arithmetic.glsl"
#include "frame/light.glsl"

// A uniform block (std140), written once a frame by frame/blocks.cpp.
struct MediumBlock {
  vec3 sigma_s;           // scattering coefficient [1/m]
  float g;                // mean cosine of Henyey-Greenstein, alone or as a part of Hoffman-Preetham
  vec3 sigma_t;           // extinction coefficient [1/m]
  float rayleigh_weight;  // of Hoffman-Preetham: the part that Rayleigh's function has, 0 to 1
  float top;              // of the layer above the eye [m]; k_no_top without
  float unused_0, unused_1, unused_2;
};

CONST float k_no_top = 1e30f;
CONST float k_endless = 1e30f;  // [m], a distance beyond all

FUNCTION bool is_layer(IN(MediumBlock) medium) { return medium.top < k_no_top; }

// Where a unit view ray that ends after `length` [m] enters the medium, and where it leaves it; the first is not less where it never
// enters. `rise`: the ray's y.
FUNCTION vec2 part_in_medium(IN(MediumBlock) medium, float rise, float length) {
  if (!is_layer(medium)) return vec2(0.0f, length);
  float crossing = abs(rise) > 1e-30f * abs(medium.top) ? medium.top / rise : k_endless;  // of the layer's top, if > 0
  if (medium.top < 0.0f) return vec2(rise < 0.0f ? crossing : k_endless, length);
  return vec2(0.0f, rise > 0.0f ? min(length, crossing) : length);
}

// The length of the light's way through the medium to a point relative to the eye [m]. A sun's has a length in a layer only:
// docs/method.md.
FUNCTION float light_path(IN(MediumBlock) medium, IN(LightBlock) light, IN(vec3) point) {
  vec3 way = to_light(light, point);
  float depth = medium.top - point.y;  // below the layer's top
  float light_depth = medium.top - light.from_eye.y;
  // Chosen from, not branched to: on this function's early returns, inside of loops, lavapipe 22.3.6 crashes.
  float crossing = max(depth, light_depth) / max(abs(depth - light_depth), 1e-30f);
  float share = max(depth, light_depth) <= 0.0f ? 0.0f : crossing;
  share = min(depth, light_depth) >= 0.0f ? 1.0f : share;
  float of_lamp = length(way) * share;
  float of_sun = max(depth, 0.0f) / way.y;
  return light.is_near == 0.0f ? (is_layer(medium) ? of_sun : 0.0f) : of_lamp;
}

#endif
