// What of a triangle a pixel covers.
#ifndef AIRLIGHT_FOOTPRINT_GLSL
#define AIRLIGHT_FOOTPRINT_GLSL
#include "frame/surface_point.glsl"

// What the weights of a triangle's corners change by where the ray turns by `turn`, to the first order (Igehy, "Tracing Ray
// Differentials", SIGGRAPH 1999, equations 10 to 12). Corners relative to the eye. Seen edge-on a pixel covers all of the triangle's
// plane: the turn is then kept finite.
FUNCTION vec3 weights_per_turn(IN(vec3) ray, IN(vec3) turn, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  vec3 ab = b - a;
  vec3 ac = c - a;
  vec3 largest = max(abs(ab), abs(ac));
  float size = max(max(largest.x, max(largest.y, largest.z)), 1e-30f);
  ab = ab / size;
  ac = ac / size;
  vec3 normal = cross(ab, ac);
  float area2 = dot(normal, normal);
  if (!(area2 > 1e-30f)) return vec3(0.0f);
  float facing = dot(normal, ray);
  float least = 1e-4f * sqrt(area2);
  facing = facing < 0.0f ? min(facing, -least) : max(facing, least);
  vec3 way = (ray_triangle_distance(ray, a, b, c) / size) * (turn - ray * (dot(normal, turn) / facing));
  float of_b = dot(cross(way, ac), normal) / area2;
  float of_c = dot(cross(ab, way), normal) / area2;
  return vec3(-of_b - of_c, of_b, of_c);
}

#endif
