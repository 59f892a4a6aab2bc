// The omnidirectional shadow map: a cube of depth images around the light, one layer a face, axes those of world space.
// Face 2a looks along +axis a, face 2a+1 along −axis a; u runs along axis a+1, v along axis a+2 (cyclic), each from
// −1 to 1.
#ifndef AIRLIGHT_SHADOW_CUBE_GLSL
#define AIRLIGHT_SHADOW_CUBE_GLSL
#include "shared.glsl"

struct CubePoint {
  int face;
  vec2 uv;      // in [−1, 1]²
  float depth;  // coordinate along the face's axis, > 0
};

// The point of the cube in direction `d`, whose depth is that of `d`; the middle of a face for a `d` of no length.
FUNCTION CubePoint cube_point(IN(vec3) d) {
  vec3 size = abs(d);
  CubePoint point;
  float along;
  vec2 across;
  if (size.x >= size.y && size.x >= size.z) {
    point.face = 0;
    along = d.x;
    across = vec2(d.y, d.z);
  } else if (size.y >= size.z) {
    point.face = 2;
    along = d.y;
    across = vec2(d.z, d.x);
  } else {
    point.face = 4;
    along = d.z;
    across = vec2(d.x, d.y);
  }
  point.face += along < 0.0f ? 1 : 0;
  point.depth = abs(along);
  point.uv = across / max(point.depth, 1e-30f);
  return point;
}

// Inverse of `cube_point` at depth 1: a direction, not of unit length.
FUNCTION vec3 cube_direction(int face, IN(vec2) uv) {
  float along = (face & 1) == 0 ? 1.0f : -1.0f;
  if (face < 2) return vec3(along, uv.x, uv.y);
  if (face < 4) return vec3(uv.y, along, uv.x);
  return vec3(uv.x, uv.y, along);
}

// The texel of a face that holds `uv`.
FUNCTION ivec2 cube_texel(IN(vec2) uv, float size) {
  vec2 texel = floor((uv * 0.5f + 0.5f) * size);
  return ivec2(clamp(texel, vec2(0.0f), vec2(size - 1.0f)));
}

// Where the centre of a texel lies on its face.
FUNCTION vec2 cube_texel_centre(IN(ivec2) texel, float size) { return (vec2(texel) + 0.5f) * (2.0f / size) - 1.0f; }

#endif
