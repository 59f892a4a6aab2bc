// How far apart things are as the light sees them, and what a bounding capsule looks like from there. Seen from a lamp a point is a
// direction, distances are angles, and a capsule is at most all that lies within an angle of an arc; seen along a sun's rays a point
// is its foot on a plane across them, distances are those of feet, and a capsule is all that lies within its radius of a segment.
// Below "arc" is meant for both.
//
// Positions are those of occlusion.glsl: relative to the lamp, under a sun to the eye. Distances are rounded: of each, `error` of
// Observer bounds the error, for points of length up to the reach that it was made for.
//
// Based on: Deves, Mora, Aveneau, Ghazanfarpour, "Scalable Real-Time Shadows using Clustering and Metric Trees", EGSR 2018,
// sections 5.2 and 6. What differs: the paper's d_near and d_far of two cones measure from one's surface, its tree and its
// traversal from its centre; here all distances are from the pivot's arc. And the farthest point of an arc need not be one of its
// ends, as a line of latitude of the sphere shows: here a bound takes its place.
#ifndef AIRLIGHT_APPARENT_GLSL
#define AIRLIGHT_APPARENT_GLSL
#include "arithmetic.glsl"
#include "frame/light_rays.glsl"

// Who looks.
struct Observer {
  LightRays rays;
  float error;  // of a distance [rad], under a sun [m, scaled]
};

// All that is seen within `width` of the arc from `from` to `to`.
struct Apparent {
  vec3 from;
  vec3 to;
  float width;
};

// Of an angle between two places: the arc tangent's, which is 1.2e-6 where sums are rounded in any direction, twice, and those of
// the places, each off by 4e-7, and as much from unit length.
CONST float k_angle_error = 5e-6f;
// Of a distance of two feet, of the reach: that of their six products and sums.
CONST float k_foot_error = 4e-6f;
// How much of a distance's error lies between what the tree decides when a capsule is inserted and when a point asks: the former
// adds two distances and a width, the latter one.
CONST float k_decisions = 4.0f;

// Where the light sees a point: its direction; under a sun its foot on the plane through the eye across the rays.
FUNCTION vec3 place_of(IN(Observer) observer, IN(vec3) point) {
  if (observer.rays.is_sun) return point - ordered_dot(observer.rays.travels, point) * observer.rays.travels;
  return unit_or(point, vec3(1.0f, 0.0f, 0.0f));
}

// Of two places.
FUNCTION float distance_between(IN(Observer) observer, IN(vec3) a, IN(vec3) b) {
  float apart = length(a - b);
  if (observer.rays.is_sun) return apart;
  return 2.0f * float(angle_of(apart, length(a + b)));
}

// Half-way between two places that are not opposite.
FUNCTION vec3 middle_of(IN(Observer) observer, IN(vec3) a, IN(vec3) b) {
  vec3 sum = float(0.5f) * (a + b);
  if (observer.rays.is_sun) return sum;
  return unit_or(sum, a);
}

// Whether an arc is so short that it counts as its first end: it is off by less than what its ends are off themselves.
FUNCTION bool is_point(IN(Observer) observer, IN(vec3) from, IN(vec3) to) { return length(to - from) <= 0.1f * observer.error; }

// The unit normal of the plane through the light and an arc that is no point, to its left. Its ends' difference is small where they
// are close; their own product would lose its digits.
FUNCTION vec3 normal_of_arc(IN(Observer) observer, IN(vec3) from, IN(vec3) to) {
  vec3 normal = cross(observer.rays.is_sun ? observer.rays.travels : from, to - from);
  return unit_or(normal / length(to - from), observer.rays.travels);
}

// How far a place lies to the left of an arc's plane.
FUNCTION float left_of_arc(IN(Observer) observer, IN(vec3) normal, IN(vec3) from, IN(vec3) place) {
  return observer.rays.is_sun ? ordered_dot(normal, place - from) : ordered_dot(normal, place);
}

// The least distance of a place from an arc.
FUNCTION float distance_to_arc(IN(Observer) observer, IN(vec3) from, IN(vec3) to, IN(vec3) place) {
  float of_ends = distance_between(observer, from, place);
  if (is_point(observer, from, to)) return of_ends;
  of_ends = min(of_ends, distance_between(observer, to, place));
  vec3 normal = normal_of_arc(observer, from, to);
  // Across the arc at either end, inward.
  vec3 along = observer.rays.is_sun ? to - from : cross(normal, from);
  vec3 back = observer.rays.is_sun ? from - to : cross(to, normal);
  bool is_beside = observer.rays.is_sun ? ordered_dot(along, place - from) >= 0.0f && ordered_dot(back, place - to) >= 0.0f
                                    : ordered_dot(along, place) >= 0.0f && ordered_dot(back, place) >= 0.0f;
  if (!is_beside) return of_ends;
  float left = abs(left_of_arc(observer, normal, from, place));
  if (observer.rays.is_sun) return left;
  return float(angle_of(left, length(cross(normal, place))));
}

// Whether two arcs cross; where rounding hides it, yes. The planes' common direction n × m lies on both arcs iff the ends of each
// lie on either side of the other's plane, in the same order: n × (c × d) = (n·d) c − (n·c) d.
FUNCTION bool arcs_may_cross(IN(Observer) observer, IN(Apparent) a, IN(Apparent) b) {
  if (is_point(observer, a.from, a.to) || is_point(observer, b.from, b.to)) return false;
  vec3 normal_a = normal_of_arc(observer, a.from, a.to);
  vec3 normal_b = normal_of_arc(observer, b.from, b.to);
  float b_from = -left_of_arc(observer, normal_a, a.from, b.from);
  float b_to = left_of_arc(observer, normal_a, a.from, b.to);
  float a_from = left_of_arc(observer, normal_b, b.from, a.from);
  float a_to = -left_of_arc(observer, normal_b, b.from, a.to);
  float least = min(min(b_from, b_to), min(a_from, a_to));
  float most = max(max(b_from, b_to), max(a_from, a_to));
  return least >= -observer.error || most <= observer.error;
}

// The least distance of two arcs.
FUNCTION float distance_of_arcs(IN(Observer) observer, IN(Apparent) a, IN(Apparent) b) {
  float least = distance_to_arc(observer, a.from, a.to, b.from);
  if (!is_point(observer, b.from, b.to)) {
    if (arcs_may_cross(observer, a, b)) return 0.0f;
    least = min(least, distance_to_arc(observer, a.from, a.to, b.to));
    least = min(least, distance_to_arc(observer, b.from, b.to, a.from));
    least = min(least, distance_to_arc(observer, b.from, b.to, a.to));
  }
  return least;
}

// Bounds of the distances from a pivot's arc to all that is seen of another capsule: d_near and d_far.
FUNCTION vec2 distances_to(IN(Observer) observer, IN(Apparent) pivot, IN(Apparent) other) {
  float nearest = distance_of_arcs(observer, pivot, other);
  float farthest = nearest;
  if (!is_point(observer, other.from, other.to)) {
    float half_length = 0.5f * distance_between(observer, other.from, other.to);
    farthest = distance_to_arc(observer, pivot.from, pivot.to, middle_of(observer, other.from, other.to)) + half_length;
  }
  return vec2(max(nearest - other.width, 0.0f), farthest + other.width);
}

// Where what is seen of a capsule lies for a pivot and a distance δ: a point of it that is at most δ from the pivot's arc, as its
// distance is rounded, is not of a capsule that is far, one that is more is not of one that is near.
CONST uint k_near = 0u;
CONST uint k_far = 1u;
CONST uint k_overlap = 2u;

// @param distances to the capsule  @param slack k_decisions errors of a distance
FUNCTION uint side_of(IN(vec2) distances, float limit, float slack) {
  if (distances.y + slack <= limit) return k_near;
  return distances.x - slack > limit ? k_far : k_overlap;
}

// A capsule in the light's coordinates.
struct Capsule {
  vec3 from;
  vec3 to;
  float radius;
};

// What is seen of a capsule.
struct SeenCapsule {
  Apparent apparent;
  float depth;   // no point of it is nearer to a lamp; or comes earlier along a sun's rays
  bool is_all;   // the light is in it, or so near that it may be seen anywhere
};

// Of coordinates' rounding, of a position's size: a corner's own and the capsule's ends'.
CONST float k_place_error = 1e-6f;
// Cosine of the longest arc between two ends: what is longer has a normal of few digits.
CONST float k_longest_arc = -0.7f;

FUNCTION SeenCapsule seen_capsule(IN(Observer) observer, IN(Capsule) capsule) {
  SeenCapsule result;
  vec3 along = capsule.to - capsule.from;
  float size = length(capsule.from) + length(capsule.to);
  float radius = capsule.radius * (1.0f + k_place_error) + k_place_error * (size + capsule.radius);
  result.apparent.from = place_of(observer, capsule.from);
  result.apparent.to = capsule.from == capsule.to ? result.apparent.from : place_of(observer, capsule.to);
  if (observer.rays.is_sun) {
    result.apparent.width = radius;
    result.depth = min(ordered_dot(observer.rays.travels, capsule.from), ordered_dot(observer.rays.travels, capsule.to)) - radius -
                 k_place_error * size;
    result.is_all = false;
    return result;
  }
  // The point of the segment that is nearest to the light.
  float length_2 = dot(along, along);
  float t = length_2 > 0.0f ? clamp(-dot(capsule.from, along) / length_2, 0.0f, 1.0f) : 0.0f;
  float nearest = length(capsule.from + t * along) - k_place_error * size;
  result.is_all = nearest <= 1.001f * radius || dot(result.apparent.from, result.apparent.to) < k_longest_arc;
  result.depth = max(nearest - radius, 0.0f) * (1.0f - k_place_error);
  float tangent = sqrt(max(nearest - radius, 0.0f) * (nearest + radius));
  result.apparent.width = float(angle_of(radius, tangent)) * (1.0f + 2.0f * k_angle_error);
  return result;
}

// Whether the light sees the fronts of all triangles of a capsule, and none from behind. Their normals lie within `opening` of
// `axis`; each triangle's corners are off by roundings, which turn a triangle the more the lower it is.
FUNCTION bool shows_fronts(IN(Observer) observer, IN(Capsule) capsule, IN(SeenCapsule) seen, IN(vec3) axis, float opening,
                           float least_altitude) {
  float turn = 5.0f * k_place_error * (length(capsule.from) + length(capsule.to) + capsule.radius);
  if (seen.is_all || turn > 0.25f * least_altitude) return false;
  float margin = opening + 1.1f * turn / least_altitude + k_decisions * k_angle_error;
  Observer angles = Observer(LightRays(observer.rays.travels, false), k_angle_error);
  float least_angle = observer.rays.is_sun ? distance_between(angles, observer.rays.travels, axis)
                                       : distance_to_arc(angles, seen.apparent.from, seen.apparent.to, axis) - seen.apparent.width;
  return least_angle - margin > 0.5f * k_pi;
}

// Whether the way from a point to the light may pass between two slabs, `lower` and `upper` above the capsule's first end along
// `axis`, within the ball around the capsule. The way goes along `to_light`, all of it.
FUNCTION bool passes_slabs(IN(Capsule) capsule, IN(vec3) axis, float lower, float upper, IN(vec3) point, IN(vec3) to_light) {
  float size = length(point) + length(to_light) + length(capsule.from) + length(capsule.to) + capsule.radius;
  float error = 10.0f * k_place_error * size;
  // The part of the way between the slabs, in parts of it.
  float climb = dot(axis, to_light);
  float first = dot(axis, capsule.from - point) + lower - error;
  float last = dot(axis, capsule.from - point) + upper + error;
  if (climb < 0.0f) {
    float other = -first;
    first = -last;
    last = other;
    climb = -climb;
  }
  if (last < 0.0f) return false;
  float steepest = climb + error;
  float flattest = climb - error;
  float begin = first > 0.0f ? first / steepest : 0.0f;
  float end = last < flattest ? last / flattest : 1.0f;
  if (begin > 1.0f + k_place_error) return false;
  // Where it comes nearest to the capsule's middle.
  vec3 middle = float(0.5f) * (capsule.from + capsule.to);
  float nearest = dot(middle - point, to_light) / max(dot(to_light, to_light), 1e-37f);
  vec3 at = point + clamp(nearest, min(begin, end), end) * to_light;
  return length(at - middle) <= capsule.radius + 0.5f * length(capsule.to - capsule.from) + error;
}

#endif
