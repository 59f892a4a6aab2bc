// A view ray in the medium, and in epipolar space. GLSL only.
#ifndef AIRLIGHT_MEDIUM_RAY_GLSL
#define AIRLIGHT_MEDIUM_RAY_GLSL
#include "epipolar/uniforms.glsl"
#include "media/layer.glsl"

layout(constant_id = 3) const uint k_phase = 0;
// k_no_layer or one of the others (layer.glsl).
layout(constant_id = 10) const uint k_layer = 0;

struct MediumRay {
  vec3 direction;
  float entry;      // where it enters the medium [m]
  float distance;   // where it ends, at a surface or by leaving the medium [m]; k_endless for neither
  EyeAngle angle;
  float alpha;
  float phi_start;  // φ of the entry
  float phi_end;    // φ of the end
  bool is_open;     // has no end
};

// The ray through a place of the image, in pixels, to a surface at the distance `surface` [m]; 0 for none.
MediumRay medium_ray(vec2 place, float surface) {
  MediumRay ray;
  ray.direction = view_ray(camera, place);
  ray.angle = eye_angle(space, ray.direction, quarter_pixel(camera));
  ray.alpha = alpha_of(ray.angle);
  ray.entry = 0.0;
  ray.distance = surface == 0.0 ? k_endless : surface;
  if (k_layer != k_no_layer) {
    vec2 part = part_in_medium(medium, ray.direction.y, ray.distance);
    if (part.x >= part.y) part = vec2(0.0);  // sees nothing of it
    ray.entry = part.x;
    ray.distance = part.y;
  }
  ray.is_open = ray.distance == k_endless;
  ray.phi_start = ray.entry == 0.0 ? 0.0 : phi_at(space, ray.angle, ray.entry);
  ray.phi_end = phi_of_end(space, ray.angle, ray.distance, ray.is_open);
  return ray;
}

// The same in its half-plane.
LayerRay in_plane(MediumRay ray) {
  vec3 outward = dot(ray.direction, space.u) * space.u + dot(ray.direction, space.f) * space.f;
  return LayerRay(ray.direction, unit_or(outward, space.u), ray.alpha, alpha_complement(ray.angle), ray.entry);
}
#endif
