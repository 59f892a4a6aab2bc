// What a display with Rec. 709 primaries shows of exposed radiance, both linear: quality/tone_map.h.
#ifndef AIRLIGHT_TONE_MAP_GLSL
#define AIRLIGHT_TONE_MAP_GLSL
#include "shared.glsl"

// In the order of scene::ToneMap.
CONST uint k_no_tone_map = 0u;
CONST uint k_reinhard = 1u;
CONST uint k_aces = 2u;
CONST uint k_agx = 3u;

FUNCTION vec3 reinhard(IN(vec3) radiance) { return radiance / (1.0f + dot(radiance, vec3(0.2126f, 0.7152f, 0.0722f))); }

// Narkowicz's fit.
FUNCTION vec3 aces(IN(vec3) x) {
  vec3 c = min(x, vec3(1e4f));  // by then it is 1
  return c * (2.51f * c + 0.03f) / (c * (2.43f * c + 0.59f) + 0.14f);
}

FUNCTION vec3 agx(IN(vec3) radiance) {
  // By rows: from Rec. 709 to AgX's own primaries, within which bright colours lose their saturation, and back.
  vec3 inset = max(vec3(dot(radiance, vec3(0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f)),
                        dot(radiance, vec3(0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f)),
                        dot(radiance, vec3(0.0423756549057051f, 0.0784336f, 0.879142973793104f))), vec3(1e-30f));
  // What the curve spans.
  float least = -12.47393f;
  float most = 4.026069f;
  vec3 x = (clamp(log2(inset), vec3(least), vec3(most)) - least) / (most - least);
  vec3 curve = (((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x - 0.00232f;
  vec3 outset = vec3(dot(curve, vec3(1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f)),
                     dot(curve, vec3(-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f)),
                     dot(curve, vec3(-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f)));
  // The curve's result is encoded for a display of gamma 2.2.
  return pow(max(outset, vec3(0.0f)), vec3(2.2f));
}

// `radiance`: not negative. Within [0, 1].
FUNCTION vec3 tone_mapped(uint tone_map, IN(vec3) radiance) {
  vec3 shown = clamp(radiance, vec3(0.0f), vec3(1e30f));
  if (tone_map == k_reinhard) shown = reinhard(shown);
  if (tone_map == k_aces) shown = aces(shown);
  if (tone_map == k_agx) shown = agx(shown);
  return min(shown, vec3(1.0f));
}

#endif
