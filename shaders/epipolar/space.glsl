// Epipolar space: where a point lies as seen from the eye and from the light at once.
//
// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, section 2.1. With eye E, light L, D = |L − E| and
// l = (L − E) / D:
//   α ∈ [0, π]      angle at the eye between l and the view ray
//   θ ∈ (−π, π]     angle of the half-plane about l that holds the ray, from u towards f
//   φ ∈ [0, π − α)  angle at the light between −l and the light ray; grows along the view ray from 0 at the eye
// A sun is a light at infinity: l points towards it, and light rays are parallels of l. In the place of φ stands s = t sin α [m], the
// distance from the axis, which is what D φ goes over into as D grows: a light ray is a line of constant (θ, s), and along it α
// grows away from the sun. What differs between the two kinds of light is in this file and, for triangles, in conservative.glsl.
// Deviation: every angle is the arc tangent of cross and dot products. The paper's acos loses half the digits near 0 and π, where
// the epipole is, and needs its argument clamped (its section 4.2).
// Points are relative to the eye, in the directions of the world's axes; light rays start at the light.
#ifndef AIRLIGHT_SPACE_GLSL
#define AIRLIGHT_SPACE_GLSL
#include "arithmetic.glsl"

// The frame of the space and the ranges of its grid; one uniform block (std140), written by epipolar/space.cpp.
struct EpipolarBlock {
  vec3 axis;         // l
  float distance;    // D [m]; 0 for a sun
  vec3 u;            // where θ = 0
  Angle alpha_min;   // α range of the grid
  vec3 f;            // where θ = π/2
  float alpha_step;  // width of a cell in α, in what alpha_spacing counts
  Angle theta_middle;  // θ range of the grid: its middle, …
  Angle theta_half;    // … and half its width, π for a full turn
  Angle theta_step;    // mean width of a cell in θ
  float theta_growth;  // g ∈ [0, 1): cells are 1 + g cos(θ − θ_middle) as dense as equal ones; 0 unless the turn is full
  float inverse_distance;  // 1/D [1/m]; 0 for a sun
  float alpha_spacing;     // of cells in α (grid.glsl): k_equal_alpha or one of the others
  float own_ranges;        // 1 where each half-plane has its own range of φ, 0 where all share one
  float unused;
};

FUNCTION bool is_sun(IN(EpipolarBlock) space) { return space.inverse_distance == 0.0f; }

// Beyond any s of a sun's light rays.
CONST Angle k_endless_phi = Angle(1e30f);

// Sine and cosine of α. Kept apart because sin α divides the airlight, and the sine of α would have lost its digits near 0 and π.
struct EyeAngle {
  float sine;
  float cosine;
};

// α of a unit view ray (from the eye) by what of it is across and along the axis, kept away from the direction to the light by
// `least_sine`, and from the opposite one, where what depends on α has a limit, by what single precision asks for.
FUNCTION EyeAngle kept_off_axis(float across, float along, float least_sine) {
  EyeAngle angle;
  angle.cosine = along;
  angle.sine = max(across, along > 0.0f ? least_sine : min(least_sine, 1e-5f));
  return angle;
}

FUNCTION EyeAngle eye_angle(IN(EpipolarBlock) space, IN(vec3) ray, float least_sine) {
  return kept_off_axis(length(cross(space.axis, ray)), dot(space.axis, ray), least_sine);
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

// φ of the light ray through a point at the distance `across` from the axis [m], from its share 1 − z/D of the distance from the
// light to the plane through the eye, z along the axis. Both may be scaled alike.
FUNCTION Angle phi_through(IN(EpipolarBlock) space, float across, float share) {
  if (is_sun(space)) return Angle(across / max(share, 1e-30f));
  return angle_of(across * space.inverse_distance, share);
}

// φ of the point at distance t > 0 along a view ray.
FUNCTION Angle phi_at(IN(EpipolarBlock) space, IN(EyeAngle) angle, float t) {
  return phi_through(space, t * angle.sine, 1.0f - t * angle.cosine * space.inverse_distance);
}

// φ where a view ray ends: at the distance t > 0, or, if open, nowhere. One arc tangent serves both.
FUNCTION Angle phi_of_end(IN(EpipolarBlock) space, IN(EyeAngle) angle, float t, bool is_open) {
  if (is_sun(space)) return is_open ? k_endless_phi : Angle(t * angle.sine);
  float turn = space.inverse_distance;
  return angle_of(is_open ? angle.sine : t * angle.sine * turn, is_open ? -angle.cosine : 1.0f - t * angle.cosine * turn);
}

// How far from the axis a light ray with φ < π/2 crosses the plane through the eye at right angles to it [m].
FUNCTION float crossing_of(IN(EpipolarBlock) space, Angle phi) {
  return is_sun(space) ? float(phi) : space.distance * sine(phi) / cosine(phi);
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
  float size = max(abs(x) + y, 1e-37f);
  return Order(x >= 0.0f ? y / size : 1.0f - x / size);  // the same but for the digits of a small angle
}

// The angle whose order it is. A quotient that is 1 may come out as 1 + 3e-7, and so the order as more than 2 or less than 0.
FUNCTION Angle angle_from_order(Order order) {
  float y = min(float(order), 2.0f - float(order));
  return angle_of(max(y, 0.0f), 1.0f - float(order));
}

// What orders light rays by φ: of a sun's, s itself.
FUNCTION Order phi_order_at(IN(EpipolarBlock) space, IN(EyeAngle) angle, float t) {
  if (is_sun(space)) return Order(t * angle.sine);
  return angle_order(t * angle.sine, space.distance - t * angle.cosine);
}

FUNCTION Order phi_order_of_open_end(IN(EpipolarBlock) space, IN(EyeAngle) angle) {
  if (is_sun(space)) return Order(float(k_endless_phi));
  return angle_order(angle.sine, -angle.cosine);
}

FUNCTION Angle phi_from_order(IN(EpipolarBlock) space, Order order) {
  return is_sun(space) ? Angle(float(order)) : angle_from_order(order);
}

#endif
