// Arithmetic that is as right on every GPU as it is here. GLSL 4.50 (section 4.7.1) bounds sums and products, to a rounding whose
// direction is open, quotients, to 2.5 ulp, and square roots, to 4.5; it bounds no function of an angle, and a compiler may
// reorder sums unless they are PRECISE. Where digits matter, take these.
#ifndef AIRLIGHT_ARITHMETIC_GLSL
#define AIRLIGHT_ARITHMETIC_GLSL
#include "shared.glsl"

CONST float k_pi = 3.14159265358979f;
CONST Angle k_half_turn = Angle(k_pi);

// dot(a, b), summed from x to z: the same bits in every program. GLSL's dot may be summed in any order, PRECISE or not.
FUNCTION float ordered_dot(IN(vec3) a, IN(vec3) b) {
  PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

// The unit vector along `v`, or `otherwise` where v is 0 or nearly. Scaled first: squares of numbers below 1e-19 are flushed to 0.
FUNCTION vec3 unit_or(IN(vec3) v, IN(vec3) otherwise) {
  float size = max(abs(v.x), max(abs(v.y), abs(v.z)));
  return size > 1e-30f ? normalize(v / size) : otherwise;
}

// Sine of an angle in [−π/2, π/2], a little beyond included, to 4e-7 of the result: a polynomial of relative error 1.1e-8, and
// roundings.
FUNCTION float sine_of_quarter(Angle x) {
  PRECISE float s = float(x) * float(x);
  PRECISE float p = 2.60539969e-6f;
  p = p * s - 1.98094393e-4f;
  p = p * s + 8.33306462e-3f;
  p = p * s - 0.166666597f;
  PRECISE float sine = float(x) + float(x) * (s * p);
  return sine;
}

// x − half_turns · π. π is the sum of two numbers, of which the first has so few digits that its product is exact.
FUNCTION Angle less_half_turns(Angle x, float half_turns) {
  PRECISE float rest = (float(x) - half_turns * 3.140625f) - half_turns * 9.67653585e-4f;
  return Angle(rest);
}

FUNCTION bool is_odd(float whole) { return whole - 2.0f * floor(0.5f * whole) != 0.0f; }

// Sine and cosine of an angle in [−4π, 4π], to 3e-7; of the result where |x| ≤ π/2 for the sine.
FUNCTION float sine(Angle x) {
  PRECISE float half_turns = floor(float(x) * 0.318309886f + 0.5f);
  float value = sine_of_quarter(less_half_turns(x, half_turns));
  return is_odd(half_turns) ? -value : value;
}

FUNCTION float cosine(Angle x) {
  PRECISE float half_turns = floor(float(x) * 0.318309886f);
  PRECISE float to_zero = half_turns + 0.5f;  // where the cosine is 0
  float value = sine_of_quarter(less_half_turns(x, to_zero));
  return is_odd(half_turns) ? value : -value;
}

// Angle of (x, y) from the x axis, in (−π, π]; 0 for (0, 0). The arc tangent of a slope up to 1 is a polynomial through its
// Chebyshev nodes, of relative error 2e-8. With roundings to nearest it is right to 2e-7 of the result, with any that GLSL
// allows to 1.2e-6. On llvmpipe it is an order of magnitude faster than GLSL's atan(y, x), and there are several a pixel.
FUNCTION Angle angle_of(float y, float x) {
  float long_side = max(abs(x), abs(y));
  float slope = min(abs(x), abs(y)) / max(long_side, 1e-37f);
  float s = slope * slope;
  float p = 0.00276628f;
  p = p * s - 0.01573125f;
  p = p * s + 0.04213762f;
  p = p * s - 0.07456855f;
  p = p * s + 0.10618371f;
  p = p * s - 0.14197798f;
  p = p * s + 0.19991872f;
  p = p * s - 0.33333037f;
  p = (p * s + 1.0f) * slope;
  p = abs(y) > abs(x) ? 0.5f * k_pi - p : p;
  p = x < 0.0f ? k_pi - p : p;
  return Angle(y < 0.0f ? -p : p);
}

#endif
