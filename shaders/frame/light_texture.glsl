// A light textured by direction: scene/light_texture.h has the convention.
#ifndef AIRLIGHT_LIGHT_TEXTURE_GLSL
#define AIRLIGHT_LIGHT_TEXTURE_GLSL
#include "arithmetic.glsl"

// Where the direction (x, y, z) from the light lies in its texture, each side from 0 to 1. `longitude` is the angle of (x, z) from
// the z axis, `latitude` that of y from the plane of the other two.
FUNCTION vec2 light_texture_place(float longitude, float latitude) {
  return vec2(0.5f - longitude * 0.159154943f, 0.5f - latitude * 0.318309886f);
}

// The four texels around a place, and how much of the second of each pair to take.
struct TexelBlend {
  ivec2 from;
  ivec2 to;
  vec2 weight;
};

// Columns go around the azimuth; there is nothing beyond the first and the last row.
FUNCTION TexelBlend light_texture_blend(IN(vec2) place, IN(ivec2) size) {
  float column = place.x * float(size.x) - 0.5f;
  float row = place.y * float(size.y) - 0.5f;
  float first_column = floor(column);
  float first_row = floor(row);
  TexelBlend blend;
  blend.weight = vec2(column - first_column, row - first_row);
  int x = int(clamp(first_column, -1.0f, float(size.x)));
  int y = int(clamp(first_row, -1.0f, float(size.y)));
  int last_x = size.x - 1;
  int last_y = size.y - 1;
  blend.from = ivec2(x < 0 ? last_x : x > last_x ? 0 : x, clamp(y, 0, last_y));
  blend.to = ivec2(blend.from.x == last_x ? 0 : blend.from.x + 1, clamp(y + 1, 0, last_y));
  return blend;
}

#endif
