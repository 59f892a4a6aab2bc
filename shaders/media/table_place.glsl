// Where the rows of the table of the airlight's integral lie in α.
#ifndef AIRLIGHT_TABLE_PLACE_GLSL
#define AIRLIGHT_TABLE_PLACE_GLSL
#include "arithmetic.glsl"

// Rows are equally far apart in place, in α 200 times as close at the ends of its range as in the middle: for α → 0 lobes
// and extinction change within an α of their own size, for α → π the path does.
CONST float k_place_growth = 100.0f;

// A number that grows with α ∈ [0, π], from 0 to 2.
FUNCTION float table_place(Angle alpha) {
  float near = max(min(float(alpha), k_pi - float(alpha)), 0.0f) / (0.5f * k_pi);
  float q = (1.0f + k_place_growth) * near;
  float place = 2.0f * q / (1.0f + sqrt(1.0f + 4.0f * k_place_growth * q));
  return float(alpha) < 0.5f * k_pi ? place : 2.0f - place;
}

// Its inverse: π − α.
FUNCTION Angle complement_at(float place) {
  float x = clamp(min(place, 2.0f - place), 0.0f, 1.0f);
  float near = 0.5f * k_pi * x * (1.0f + k_place_growth * x) / (1.0f + k_place_growth);
  return Angle(place < 1.0f ? k_pi - near : near);
}

#endif
