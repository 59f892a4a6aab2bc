// Whether a triangle hides a point from the light: the one predicate that every exact method of surface shadows asks. What prunes
// triangles before it, a tree or silhouettes, must only never leave out one that it would have called.
//
// Positions are relative to the light, those under a sun to the eye, rounded to single precision once and scaled by one power of
// two, so that products of three stay in range. With the light at the origin, the triangle abc whose corners are ordered so that
// det(a, b, c) > 0 hides P iff
//     det(a, b − a, P) ≥ 0,  det(b, c − b, P) ≥ 0,  det(c, a − c, P) ≥ 0   and   det(b − a, c − a, P − a) > 0,
// under a sun whose light travels along d, the corners ordered so that det(d, b − a, c − a) > 0, iff
//     det(d, b − a, P − a) ≥ 0, …                                          and   det(b − a, c − a, P − a) > 0.
// The first three say that P lies in the beam through the triangle, its sides included, the last that it lies beyond.
//
// Two triangles that share an edge never disagree on which side of it P lies: its determinant is computed from its ends in the
// order of their coordinates, whichever way a triangle goes round, so that both see the same number, one with its sign turned.
//
// Based on: Gerhards, Mora, Aveneau, Ghazanfarpour, "Partitioned Shadow Volumes", Eurographics 2015, section 3.2, whose frustum of
// four planes this is. It stores planes, normalised and rounded, and compares points with those: neighbours then disagree on
// their edge by roundings. The filter after Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", 1997, section 2.
#ifndef AIRLIGHT_OCCLUSION_GLSL
#define AIRLIGHT_OCCLUSION_GLSL
#include "frame/determinant.glsl"
#include "frame/light_rays.glsl"

// A triangle, corners in the order that the predicate wants.
struct Occluder {
  vec3 a;
  vec3 b;
  vec3 c;
};

FUNCTION bool comes_before(IN(vec3) a, IN(vec3) b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

// Which way round the corners are as the light sees them: the sign of det(a, b, c), of a sun det(d, b − a, c − a). 0 of a triangle
// that the light sees edge-on, which hides nothing.
FUNCTION float turn_of(IN(LightRays) rays, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  PRECISE vec3 ab = b - a;
  PRECISE vec3 ac = c - a;
  float turn = determinant_sign_32(rays.is_sun ? rays.travels : a, ab, ac);
  if (turn != 0.0f) return turn;
  dvec3 apex = dvec3(rays.is_sun ? rays.travels : a);
  return determinant_sign_64(apex, dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
}

// On which side a point lies of the plane through the light and an edge: 1 to the left of it as the light sees it, 0 on it.
FUNCTION float side_of_edge(IN(LightRays) rays, IN(vec3) from, IN(vec3) to, IN(vec3) point) {
  bool is_turned = comes_before(to, from);
  vec3 first = is_turned ? to : from;
  vec3 last = is_turned ? from : to;
  PRECISE vec3 edge = last - first;
  PRECISE vec3 way = point - first;
  float side = rays.is_sun ? determinant_sign_32(rays.travels, edge, way) : determinant_sign_32(first, edge, point);
  if (side == 0.0f) {
    dvec3 long_edge = dvec3(last) - dvec3(first);
    side = rays.is_sun ? determinant_sign_64(dvec3(rays.travels), long_edge, dvec3(point) - dvec3(first))
                       : determinant_sign_64(dvec3(first), long_edge, dvec3(point));
  }
  return is_turned ? -side : side;
}

// On which side a point lies of the plane through a triangle: 1 where its corners go round clockwise, 0 on it.
FUNCTION float side_of_plane(IN(vec3) a, IN(vec3) b, IN(vec3) c, IN(vec3) point) {
  PRECISE vec3 ab = b - a;
  PRECISE vec3 ac = c - a;
  PRECISE vec3 way = point - a;
  float side = determinant_sign_32(ab, ac, way);
  if (side != 0.0f) return side;
  dvec3 origin = dvec3(a);
  return determinant_sign_64(dvec3(b) - origin, dvec3(c) - origin, dvec3(point) - origin);
}

// The predicate, for triangles that let nothing through: to touch one is to be hidden.
FUNCTION bool hides(IN(LightRays) rays, IN(Occluder) triangle, IN(vec3) point) {
  return side_of_edge(rays, triangle.a, triangle.b, point) >= 0.0f && side_of_edge(rays, triangle.b, triangle.c, point) >= 0.0f &&
         side_of_edge(rays, triangle.c, triangle.a, point) >= 0.0f &&
         side_of_plane(triangle.a, triangle.b, triangle.c, point) > 0.0f;
}

// On which side of the plane through the light and an edge a point counts that lies on it: the one to which the plane's normal shows
// by its first component that is not 0. So does a point that is moved a little along x, less along y and least along z.
// 0 of an edge that the light sees as a point. Products of two floats are exact in double precision, and so is the sign of a
// difference of two; under a sun they are rounded, for all triangles alike.
FUNCTION float side_of_plane_of_edge(IN(LightRays) rays, IN(vec3) from, IN(vec3) to) {
  bool is_turned = comes_before(to, from);
  dvec3 u = dvec3(is_turned ? to : from);
  dvec3 v = dvec3(is_turned ? from : to);
  if (rays.is_sun) {
    v = v - u;
    u = dvec3(rays.travels);
  }
  PRECISE dvec3 first = dvec3(u.y * v.z, u.z * v.x, u.x * v.y);
  PRECISE dvec3 second = dvec3(u.z * v.y, u.x * v.z, u.y * v.x);
  float side = 0.0f;
  for (int i = 0; i < 3; ++i)
    if (side == 0.0f) side = first[i] > second[i] ? 1.0f : first[i] < second[i] ? -1.0f : 0.0f;
  return is_turned ? -side : side;
}

// Whether the light's ray to a point crosses a triangle, where each is counted: of the triangles that share an edge or a corner
// that the ray meets, the ray crosses one of each sheet.
FUNCTION bool crosses(IN(LightRays) rays, IN(Occluder) triangle, IN(vec3) point) {
  vec3 corners[4];
  corners[0] = triangle.a;
  corners[1] = triangle.b;
  corners[2] = triangle.c;
  corners[3] = triangle.a;
  bool is_between = true;
  for (int i = 0; i < 3; ++i) {
    float side = side_of_edge(rays, corners[i], corners[i + 1], point);
    if (side == 0.0f) side = side_of_plane_of_edge(rays, corners[i], corners[i + 1]);
    is_between = is_between && side > 0.0f;
  }
  return is_between && side_of_plane(triangle.a, triangle.b, triangle.c, point) > 0.0f;
}

// Whether the plane of a triangle parts the eye from the light: what is seen of it then turns its back to the light.
FUNCTION bool parts_eye_from_light(IN(LightRays) rays, IN(vec3) a, IN(vec3) b, IN(vec3) c, IN(vec3) eye) {
  // Light reaches the side towards which −d, or the origin from the plane, lies: where the turn is positive, that of side −1.
  return turn_of(rays, a, b, c) * side_of_plane(a, b, c, eye) > 0.0f;
}

#endif
