// Where the ray of a pixel's row of bits meets the surface that the pixel sees.
#ifndef AIRLIGHT_ROW_END_GLSL
#define AIRLIGHT_ROW_END_GLSL
#include "epipolar/space.glsl"

// How much φ grows from the end of the pixel's ray to where the row's ray meets the same plane, or to the end of a row's ray that
// never meets it; in [−π, π]. `surface`: the plane's normal, towards the eye, and the distance to it along `direction`, the
// pixel's ray. `d_alpha` and `d_theta` lead from that ray to the row's, which is taken to first order in them.
// For the row's ray the plane lies `nearer` [m] to the eye than it does.
//
// All is in the half-plane, seen from the light: a point's distance from the axis, and its share of the distance from the light
// (phi_through).
//
// Row and pixel's ray end at (across, along), in the half-plane from the light, the row's scaled by `facing`: the more the row's
// ray grazes the plane, the farther away it meets it, and where facing = 0 only its direction is left. No quotient is taken
// that could be infinite.
FUNCTION Angle phi_to_row_end(IN(EpipolarBlock) space, IN(EyeAngle) angle, IN(vec3) direction, IN(vec4) surface,
                              Angle d_alpha, Angle d_theta, float nearer) {
  vec3 normal = vec3(surface.x, surface.y, surface.z);
  float across = surface.w * angle.sine;
  float share = 1.0f - surface.w * angle.cosine * space.inverse_distance;
  vec3 outward = (direction - angle.cosine * space.axis) / angle.sine;
  vec3 row_direction = direction + float(d_alpha) * (angle.cosine * outward - angle.sine * space.axis) +
                       float(d_theta) * angle.sine * cross(space.axis, outward);
  float plane = max(-surface.w * dot(normal, direction) - nearer, 0.0f);  // its distance from the eye
  float facing = max(-dot(normal, row_direction), 0.0f);
  float row_across = plane * (angle.sine + float(d_alpha) * angle.cosine);
  float row_share = facing - plane * (angle.cosine - float(d_alpha) * angle.sine) * space.inverse_distance;
  float to_row = row_across * share - row_share * across;
  if (is_sun(space)) return Angle(to_row / max(facing, 1e-20f * abs(to_row) + 1e-30f));
  float turn = space.inverse_distance;
  return angle_of(to_row * turn, row_share * share + row_across * across * turn * turn);
}

#endif
