// Epipolar space: where a point lies as seen from the eye and from the light at once.
//
// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, section 2.1. With eye E, light L, D = |L − E| and
// l = (L − E) / D:
//   α ∈ [0, π]      angle at the eye between l and the view ray
//   θ ∈ (−π, π]     angle of the half-plane about l that holds the ray, from u towards f
//   φ ∈ [0, π − α)  angle at the light between −l and the light ray; grows along the view ray from 0 at the eye
// Deviation: every angle is the arc tangent of cross and dot products. The paper's acos loses half the digits near 0 and π, where
// the epipole is, and needs its argument clamped (its section 4.2).
// Points are relative to the eye, in the directions of the world's axes; light rays start at the light.
#ifndef AIRLIGHT_SPACE_GLSL
#define AIRLIGHT_SPACE_GLSL
#include "arithmetic.glsl"

// The frame of the space and the ranges of its grid; one uniform block (std140), written by epipolar/space.cpp.
struct EpipolarBlock {
  vec3 axis;         // l
  float distance;    // D [m]
  vec3 u;            // where θ = 0
  Angle alpha_min;   // α range of the grid
  vec3 f;            // where θ = π/2
  Angle alpha_step;  // width of a cell in α
  Angle theta_middle;  // θ range of the grid: its middle, …
  Angle theta_half;    // … and half its width, π for a full turn
  Angle theta_step;    // mean width of a cell in θ
  float theta_growth;  // g ∈ [0, 1): cells are 1 + g cos(θ − θ_middle) as dense as equal ones; 0 unless the turn is full
};

// Sine and cosine of α. Kept apart because sin α divides the airlight, and the sine of α would have lost its digits near 0 and π.
struct EyeAngle {
  float sine;
  float cosine;
};

// α of a unit view ray (from the eye), kept away from the direction to the light by `least_sine`, and from the opposite one,
// where what depends on α has a limit, by what single precision asks for.
FUNCTION EyeAngle eye_angle(IN(EpipolarBlock) space, IN(vec3) ray, float least_sine) {
  EyeAngle angle;
  angle.cosine = dot(space.axis, ray);
  angle.sine = max(length(cross(space.axis, ray)), angle.cosine > 0.0f ? least_sine : min(least_sine, 1e-5f));
  return angle;
}

FUNCTION Angle alpha_of(IN(EyeAngle) angle) { return angle_of(angle.sine, angle.cosine); }

// π − α, with all digits where α is near π.
FUNCTION Angle alpha_complement(IN(EyeAngle) angle) { return angle_of(angle.sine, -angle.cosine); }

// θ of a vector from any point of the axis; 0 on the axis, where it has none.
FUNCTION Angle theta_of(IN(EpipolarBlock) space, IN(vec3) vector) {
  float y = dot(vector, space.f);
  float x = dot(vector, space.u);
  return angle_of(y, x);
}

// φ of the point at distance t > 0 along a view ray.
FUNCTION Angle phi_at(IN(EpipolarBlock) space, IN(EyeAngle) angle, float t) {
  return angle_of(t * angle.sine, space.distance - t * angle.cosine);
}

// α of the point at distance r from the light on a light ray at φ.
FUNCTION Angle alpha_at(IN(EpipolarBlock) space, float sin_phi, float cos_phi, float r) {
  return angle_of(r * sin_phi, space.distance - r * cos_phi);
}

// Length of the path from the light to the eye by way of (α, φ): t + r = D cos((α − φ)/2) / cos((α + φ)/2), which has
// no 0/0. Taken from π − α, it keeps its digits near α = π, where both sines are small. Infinite at α + φ = π.
FUNCTION float path_length(IN(EpipolarBlock) space, Angle complement, Angle phi) {
  float opening = sine_of_quarter(0.5f * max(complement - phi, Angle(0.0f)));  // cos((α + φ)/2)
  float closing = sine(0.5f * (complement + phi));                             // cos((α − φ)/2)
  return opening > 0.0f ? space.distance * closing / opening : 1e30f;
}

// A number in [0, 2] that grows with the angle of (x, y), y ≥ 0, from 0 at +x to 2 at −x: what is enough to find the
// largest of many angles.
FUNCTION Order angle_order(float y, float x) {
  float size = abs(x) + y;
  return Order(size > 1e-37f ? 1.0f - x / size : 0.0f);
}

// The angle whose order it is. A quotient that is 1 may come out as 1 + 3e-7, and so the order as more than 2 or less than 0.
FUNCTION Angle angle_from_order(Order order) {
  float x = 1.0f - float(order);
  return angle_of(max(1.0f - abs(x), 0.0f), x);
}

#endif
