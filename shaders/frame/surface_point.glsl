// What a pixel shades: a point of the triangle seen there, given by weights of its corners, and from them its position relative to
// the light. Whoever asks for shadows asks of that very point.
#ifndef AIRLIGHT_SURFACE_POINT_GLSL
#define AIRLIGHT_SURFACE_POINT_GLSL
#include "frame/camera.glsl"

// Weights are at least this. Rasterisers snap corners to 1/256 pixel, and so show a triangle up to that far outside of it, where
// its neighbours, and it alone not, would hide the point.
CONST float k_least_weight = 1.52587890625e-5f;  // 2⁻¹⁶

// The weights of a triangle's corners where the view ray meets its plane; corners relative to the eye. Inside the triangle, also of a
// ray that misses it.
FUNCTION vec3 surface_weights(IN(vec3) ray, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  vec3 ab = b - a;
  vec3 ac = c - a;
  // Scaled: a product of four lengths would leave the range of single precision.
  vec3 largest = max(abs(ab), abs(ac));
  float size = max(max(largest.x, max(largest.y, largest.z)), 1e-30f);
  ab = ab / size;
  ac = ac / size;
  vec3 way = (ray_triangle_distance(ray, a, b, c) * ray - a) / size;
  vec3 normal = cross(ab, ac);
  float area2 = dot(normal, normal);
  if (!(area2 > 1e-30f)) return vec3(1.0f / 3.0f);
  float of_b = clamp(dot(cross(way, ac), normal) / area2, 0.0f, 1.0f);
  float of_c = clamp(dot(cross(ab, way), normal) / area2, 0.0f, 1.0f);
  vec3 weights = max(vec3(1.0f - of_b - of_c, of_b, of_c), vec3(k_least_weight));
  return weights / (weights.x + weights.y + weights.z);
}

// The point itself, for corners relative to anything.
FUNCTION vec3 weighted(IN(vec3) weights, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  PRECISE vec3 point = weights.x * a + weights.y * b + weights.z * c;
  return point;
}

#endif
