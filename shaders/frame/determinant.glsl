// Signs of determinants, right or 0: single precision where its error cannot matter, else double precision, which GLSL has and
// which every driver of OpenGL 4 gives.
//
// Each sum and product is rounded by less than 2⁻²³ of itself in single precision, in whatever direction (GLSL 4.50, section
// 4.7.1), and by less than 2⁻⁵² in double. det(a, b, c) = Σ aᵢ (bⱼ cₖ − bₖ cⱼ) has five roundings on the way of each of its six
// products, and up to three more where its columns are differences: 8 · 2⁻²³ = 16 · 2⁻²⁴ of the sum of their absolute values, the
// permanent. A seventeenth part stands for the rounding of that sum itself.
//
// Coordinates are scaled (occlusion.glsl) so that the largest products of three stay below the largest float; products that
// are flushed to 0 are each below 2⁻¹²⁶.
#ifndef AIRLIGHT_DETERMINANT_GLSL
#define AIRLIGHT_DETERMINANT_GLSL
#include "shared.glsl"

CONST float k_determinant_error = 1.01327896e-6f;  // 17 · 2⁻²⁴
CONST float k_flushed = 1e-36f;
// 17 · 2⁻⁵³, from floats: GLSL and C++ write doubles differently.
CONST double k_determinant_error_64 = double(k_determinant_error) / double(536870912.0f);

// −1, 0 or 1; `error` is that of the value.
FUNCTION float sign_beyond(float value, float error) { return value > error ? 1.0f : value < -error ? -1.0f : 0.0f; }

// In single precision; 0 where it cannot tell.
FUNCTION float determinant_sign_32(IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  PRECISE vec3 first = vec3(b.y * c.z, b.z * c.x, b.x * c.y);
  PRECISE vec3 second = vec3(b.z * c.y, b.x * c.z, b.y * c.x);
  PRECISE vec3 minors = first - second;
  PRECISE float value = a.x * minors.x + a.y * minors.y + a.z * minors.z;
  vec3 sizes = abs(first) + abs(second);
  float permanent = abs(a.x) * sizes.x + abs(a.y) * sizes.y + abs(a.z) * sizes.z;
  return sign_beyond(value, k_determinant_error * permanent + k_flushed);
}

// In double precision; 0 of what is 0, and of nothing else that is more than 17 · 2⁻⁵³ of its permanent.
FUNCTION float determinant_sign_64(IN(dvec3) a, IN(dvec3) b, IN(dvec3) c) {
  PRECISE dvec3 first = dvec3(b.y * c.z, b.z * c.x, b.x * c.y);
  PRECISE dvec3 second = dvec3(b.z * c.y, b.x * c.z, b.y * c.x);
  PRECISE dvec3 minors = first - second;
  PRECISE double value = a.x * minors.x + a.y * minors.y + a.z * minors.z;
  dvec3 sizes = abs(first) + abs(second);
  double error = k_determinant_error_64 * (abs(a.x) * sizes.x + abs(a.y) * sizes.y + abs(a.z) * sizes.z);
  return value > error ? 1.0f : value < -error ? -1.0f : 0.0f;
}

#endif
