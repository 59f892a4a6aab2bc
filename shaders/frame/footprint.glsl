// What of a triangle a pixel covers.
#ifndef AIRLIGHT_FOOTPRINT_GLSL
#define AIRLIGHT_FOOTPRINT_GLSL
#include "frame/surface_point.glsl"

// What the weights of a triangle's corners change by where the ray turns by `turn`, to the first order (Igehy, "Tracing Ray
// Differentials", SIGGRAPH 1999, equations 10 to 12). Corners relative to the eye. Seen edge-on a pixel covers all of the triangle's
// plane: the turn is then kept finite.
FUNCTION vec3 weights_per_turn(IN(vec3) ray, IN(vec3) turn, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  ScaledTriangle scaled = scaled_triangle(a, b, c);
  if (scaled.is_thin) return vec3(0.0f);
  float facing = dot(scaled.normal, ray);
  float least = 1e-4f * sqrt(scaled.area2);
  facing = facing < 0.0f ? min(facing, -least) : max(facing, least);
  vec3 way = (ray_triangle_distance(ray, a, b, c) / scaled.size) * (turn - ray * (dot(scaled.normal, turn) / facing));
  vec2 edges = along_edges(scaled, way);
  return vec3(-edges.x - edges.y, edges.x, edges.y);
}

#endif
