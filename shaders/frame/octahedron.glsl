// Unit vectors as two numbers in [−1, 1], of 16 bits each: the octahedron about the sphere, unfolded (Cigolle et al., "A Survey of
// Efficient Representations for Independent Unit Vectors", JCGT 3(2), 2014, "oct").
#ifndef AIRLIGHT_OCTAHEDRON_GLSL
#define AIRLIGHT_OCTAHEDRON_GLSL
#include "shared.glsl"

FUNCTION vec2 fold_over(IN(vec2) p) {
  return vec2((1.0f - abs(p.y)) * (p.x < 0.0f ? -1.0f : 1.0f), (1.0f - abs(p.x)) * (p.y < 0.0f ? -1.0f : 1.0f));
}

FUNCTION uint octahedron_of(IN(vec3) unit) {
  vec2 p = vec2(unit.x, unit.y) / (abs(unit.x) + abs(unit.y) + abs(unit.z));
  if (unit.z < 0.0f) p = fold_over(p);
  // As packSnorm2x16, which zink 22.3.6 does not know.
  ivec2 bits = ivec2(floor(clamp(p, vec2(-1.0f), vec2(1.0f)) * 32767.0f + 0.5f));
  return (uint(bits.x) & 0xffffu) | (uint(bits.y) << 16u);
}

FUNCTION vec3 of_octahedron(uint packed) {
  vec2 p = vec2(float(int(packed << 16u) >> 16), float(int(packed) >> 16)) / 32767.0f;
  float z = 1.0f - abs(p.x) - abs(p.y);
  if (z < 0.0f) p = fold_over(p);
  return normalize(vec3(p, z));
}

#endif
