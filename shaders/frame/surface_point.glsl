// What a pixel shades: a point of the triangle seen there, given by weights of its corners, and from them its position relative to
// the light. Whoever asks for shadows asks of that very point.
#ifndef AIRLIGHT_SURFACE_POINT_GLSL
#define AIRLIGHT_SURFACE_POINT_GLSL
#include "frame/camera.glsl"

// Weights are at least this. Rasterisers snap corners to 1/256 pixel, and so show a triangle up to that far outside of it, where
// its neighbours, and it alone not, would hide the point.
CONST float k_least_weight = 1.52587890625e-5f;  // 2⁻¹⁶

// A triangle's edges over the largest of their coordinates: a product of four lengths would leave the range of single precision.
struct ScaledTriangle {
  vec3 ab;
  vec3 ac;
  float size;    // what they are divided by [m]
  vec3 normal;   // ab × ac
  float area2;   // its square
  bool is_thin;  // has no area in single precision
};

FUNCTION ScaledTriangle scaled_triangle(IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  ScaledTriangle scaled;
  vec3 ab = b - a;
  vec3 ac = c - a;
  vec3 largest = max(abs(ab), abs(ac));
  scaled.size = max(max(largest.x, max(largest.y, largest.z)), 1e-30f);
  scaled.ab = ab / scaled.size;
  scaled.ac = ac / scaled.size;
  scaled.normal = cross(scaled.ab, scaled.ac);
  scaled.area2 = dot(scaled.normal, scaled.normal);
  scaled.is_thin = !(scaled.area2 > 1e-30f);
  return scaled;
}

// By how much of ab and of ac one goes along `way`, which is scaled as they are.
FUNCTION vec2 along_edges(IN(ScaledTriangle) scaled, IN(vec3) way) {
  return vec2(dot(cross(way, scaled.ac), scaled.normal) / scaled.area2, dot(cross(scaled.ab, way), scaled.normal) / scaled.area2);
}

// The weights of a triangle's corners where the view ray meets its plane; corners relative to the eye. Inside the triangle, also of a
// ray that misses it.
FUNCTION vec3 surface_weights(IN(vec3) ray, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  ScaledTriangle scaled = scaled_triangle(a, b, c);
  if (scaled.is_thin) return vec3(1.0f / 3.0f);
  vec3 way = (ray_triangle_distance(ray, a, b, c) * ray - a) / scaled.size;
  vec2 edges = clamp(along_edges(scaled, way), vec2(0.0f), vec2(1.0f));
  vec3 weights = max(vec3(1.0f - edges.x - edges.y, edges.x, edges.y), vec3(k_least_weight));
  return weights / (weights.x + weights.y + weights.z);
}

// The point itself, for corners relative to anything.
FUNCTION vec3 weighted(IN(vec3) weights, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  PRECISE vec3 point = weights.x * a + weights.y * b + weights.z * c;
  return point;
}

#endif
