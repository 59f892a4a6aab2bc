#pragma once

#include "epipolar/space_math.h"
#include "support/rough.h"

/// The functions of shaders/ a second time, in rough arithmetic.
namespace airlight::rough {

using uint = std::uint32_t;
using vec2 = glm::vec<2, Rough>;
using vec3 = glm::vec<3, Rough>;
using vec4 = glm::vec<4, Rough>;
using Angle = shaders::Quantity<Rough, shaders::Radians>;
using Order = shaders::Quantity<Rough, shaders::OrderOfAngle>;
using Cell = shaders::Quantity<Rough, shaders::CellsOfAxis>;

inline Rough dot(const vec2& a, const vec2& b) {
  return a.x * b.x + a.y * b.y;
}
inline Rough dot(const vec3& a, const vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Rough length(const vec2& a) {
  return sqrt(dot(a, a));
}
inline Rough length(const vec3& a) {
  return sqrt(dot(a, a));
}
inline vec3 normalize(const vec3& a) {
  return a / length(a);
}
inline vec3 cross(const vec3& a, const vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#undef AIRLIGHT_ARITHMETIC_GLSL
#undef AIRLIGHT_SPACE_GLSL
#undef AIRLIGHT_GRID_GLSL
#undef AIRLIGHT_CONSERVATIVE_GLSL
#define float Rough
#include "epipolar/conservative.glsl"
#undef float

}  // namespace airlight::rough
