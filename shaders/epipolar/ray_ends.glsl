// Where view rays end, of each half-plane the largest φ. GLSL only.
#define PHI_RANGE_ACCESS
#include "epipolar/uniforms.glsl"
#include "epipolar/phi_range.glsl"

// Of the rays of one half-plane that an invocation has seen last.
struct RayEnds {
  uint plane;
  float largest;
};

void note_ends(RayEnds ends) {
  if (ends.largest > uintBitsToFloat(seen[ends.plane])) atomicMax(seen[ends.plane], floatBitsToUint(ends.largest));
}

// The ray through a place of the image, in pixels, to a surface at the distance t [m]; 0 for none.
void see_end(inout RayEnds ends, vec2 place, float t) {
  // α and θ from the same two coordinates across the axis: a range need not have every digit near it.
  vec3 direction = view_ray(camera, place);
  vec2 across = vec2(dot(direction, space.u), dot(direction, space.f));
  EyeAngle angle = kept_off_axis(length(across), dot(direction, space.axis), quarter_pixel(camera));
  float order = t > 0.0 ? phi_order_at(space, angle, t) : phi_order_of_open_end(space, angle);
  uint plane = theta_cell(space, angle_of(across.y, across.x), k_theta_count);
  if (plane != ends.plane) {
    note_ends(ends);
    ends = RayEnds(plane, 0.0);
  }
  ends.largest = max(ends.largest, order);
}
