// Which voxels a triangle touches.
//
// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, sections 4.1.1 and 4.1.2; and what it takes from Schwarz and
// Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia 2010.
// Deviation: nothing is split. The triangle is cut by the two half-planes that bound one cell of θ, its slab, one cell after
// another, so that a triangle may wrap over θ = ±π, hold the epipole or pass behind the eye or the light. And no
// edge is taken to be straight that is not: seen along the slab (coordinates z along the axis, x outwards), lines are lines,
// and the cells of α and φ are bounded by lines through the eye and the light. What is left of the curvature, that
// x = ρ cos(θ − θ_j) stands for the distance ρ from the axis, is bounded by x ≤ ρ ≤ x / cos(half a slab).
//
// All lengths carry a slack [m], the most that single precision misplaces a point; it makes the result
// larger, never smaller.
#ifndef AIRLIGHT_CONSERVATIVE_GLSL
#define AIRLIGHT_CONSERVATIVE_GLSL
#include "epipolar/grid.glsl"

// No slab is wider than this, so that tan and 1/cos of its half stay small: a wide cell of θ is cut into several.
CONST float k_widest_slab = 0.2f;  // [rad]

// How many slabs a cell of θ has.
FUNCTION uint slabs_per_plane(IN(EpipolarBlock) space) {
  return uint(ceil(space.theta_step / ((1.0f - space.theta_growth) * k_widest_slab)));
}

// What single precision may misplace a point of the triangle by: relative to the eye, its coordinates along the axes of
// epipolar space are sums of three products of numbers rounded to 6e-8 [m].
FUNCTION float position_slack(IN(EpipolarBlock) space, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  float largest = max(dot(a, a), max(dot(b, b), dot(c, c)));
  return 1e-6f * max(sqrt(largest), space.distance);
}

// The least distance from the origin to the segment (a, b).
FUNCTION float distance_to_segment(IN(vec2) a, IN(vec2) b) {
  vec2 along = b - a;
  float t = clamp(-dot(a, along) / max(dot(along, along), 1e-37f), 0.0f, 1.0f);
  return length(a + t * along);
}

// An angle in (−2π, 2π) as one in [−π, π].
FUNCTION float wrapped(float angle) {
  return angle > k_pi ? angle - 2.0f * k_pi : angle < -k_pi ? angle + 2.0f * k_pi : angle;
}

// The planes whose cells a triangle may touch: two runs, the second one for what wraps over the end of a full turn.
struct PlaneSpan {
  uint first;
  uint count;
  uint wrapped_first;
  uint wrapped_count;
};

FUNCTION uint clamped_plane(IN(EpipolarBlock) space, float from_middle, uint theta_count) {
  float plane = floor(plane_of_theta(space, clamp(from_middle, -k_pi, k_pi)));
  return uint(clamp(plane, 0.0f, float(theta_count) - 1.0f));
}

// `a`, `b`, `c`: the corners' coordinates along u and f.
FUNCTION PlaneSpan planes_of_triangle(IN(EpipolarBlock) space, IN(vec2) a, IN(vec2) b, IN(vec2) c, float slack,
                                      uint theta_count) {
  float nearest = min(distance_to_segment(a, b), min(distance_to_segment(b, c), distance_to_segment(c, a)));
  float ab = a.x * b.y - a.y * b.x;
  float bc = b.x * c.y - b.y * c.x;
  float ca = c.x * a.y - c.y * a.x;
  bool holds_axis = (ab >= 0.0f && bc >= 0.0f && ca >= 0.0f) || (ab <= 0.0f && bc <= 0.0f && ca <= 0.0f);
  PlaneSpan span;
  span.first = 0u;
  span.count = theta_count;
  span.wrapped_first = 0u;
  span.wrapped_count = 0u;
  if (holds_axis || nearest <= 2.0f * slack) return span;

  // Seen along the axis, a triangle beside the origin spans less than π.
  float theta_a = angle_of(a.y, a.x);
  float to_b = wrapped(angle_of(b.y, b.x) - theta_a);
  float to_c = wrapped(angle_of(c.y, c.x) - theta_a);
  float margin = 2.0f * slack / nearest + 2e-6f;
  float lower = wrapped(theta_a - space.theta_middle) + min(0.0f, min(to_b, to_c)) - margin;
  float upper = wrapped(theta_a - space.theta_middle) + max(0.0f, max(to_b, to_c)) + margin;
  float turn = lower < -k_pi ? 2.0f * k_pi : 0.0f;
  lower += turn;
  upper += turn;
  span.count = 0u;
  if (lower <= space.theta_half && upper >= -space.theta_half) {
    span.first = clamped_plane(space, lower, theta_count);
    span.count = clamped_plane(space, upper, theta_count) - span.first + 1u;
  }
  if (upper - 2.0f * k_pi >= -space.theta_half) {
    span.wrapped_first = clamped_plane(space, lower - 2.0f * k_pi, theta_count);
    span.wrapped_count = clamped_plane(space, upper - 2.0f * k_pi, theta_count) - span.wrapped_first + 1u;
  }
  return span;
}

FUNCTION uint plane_count(IN(PlaneSpan) span) { return span.count + span.wrapped_count; }

// The `index`th plane of a span.
FUNCTION uint plane_at(IN(PlaneSpan) span, uint index) {
  return index < span.count ? span.first + index : span.wrapped_first + (index - span.count);
}

// The outline of the part of a triangle in a slab, seen along it: segments (x, w) to (x, w), with x outwards from the
// axis and w towards the eye from the light. A segment that is not there has x < 0.
struct SlabOutline {
  vec4 segment[5];
};

// Keeps the part of [range.x, range.y] ⊂ [0, 1] where a linear function is not negative, f_0 at 0 and f_1 at 1. None is left
// where range.x > range.y.
FUNCTION vec2 clip(IN(vec2) range, float f_0, float f_1) {
  float root = f_0 / (f_0 - f_1);  // used only where the signs differ
  float lower = f_0 < 0.0f ? (f_1 < 0.0f ? 2.0f : root) : 0.0f;
  float upper = f_1 < 0.0f ? (f_0 < 0.0f ? -1.0f : root) : 1.0f;
  return vec2(max(range.x, lower), min(range.y, upper));
}

FUNCTION vec4 part_of(IN(vec3) a, IN(vec3) b, IN(vec2) range) {
  if (range.x > range.y) return vec4(-1.0f);
  vec3 from = a + range.x * (b - a);
  vec3 to = a + range.y * (b - a);
  return vec4(max(from.x, 0.0f), from.y, max(to.x, 0.0f), to.y);
}

// `a`, `b`, `c`: the corners as (x, w, y), with y at right angles to the slab's middle plane. `tangent`: of half the
// slab's angle.
FUNCTION SlabOutline outline_in_slab(IN(vec3) a, IN(vec3) b, IN(vec3) c, float tangent, float slack) {
  SlabOutline outline;
  vec3 corner[4];
  corner[0] = a;
  corner[1] = b;
  corner[2] = c;
  corner[3] = a;
  // The triangle's edges within the slab.
  for (int i = 0; i < 3; ++i) {
    vec3 p = corner[i];
    vec3 q = corner[i + 1];
    vec2 range = clip(vec2(0.0f, 1.0f), p.x * tangent - p.z + slack, q.x * tangent - q.z + slack);
    range = clip(range, p.x * tangent + p.z + slack, q.x * tangent + q.z + slack);
    range = clip(range, p.x + slack, q.x + slack);
    outline.segment[i] = part_of(p, q, range);
  }
  // Where the slab's two sides cut the triangle.
  for (int side = 0; side < 2; ++side) {
    float sign = side == 0 ? 1.0f : -1.0f;
    vec3 from = vec3(-1.0f);
    vec3 to = vec3(-1.0f);
    bool is_cut = false;
    for (int i = 0; i < 3; ++i) {
      vec3 p = corner[i];
      vec3 q = corner[i + 1];
      float f_p = p.x * tangent - sign * p.z + slack;
      float f_q = q.x * tangent - sign * q.z + slack;
      if ((f_p < 0.0f) != (f_q < 0.0f)) {
        vec3 crossing = p + f_p / (f_p - f_q) * (q - p);
        from = is_cut ? from : crossing;
        to = crossing;
        is_cut = true;
      }
    }
    vec2 range = is_cut ? vec2(0.0f, 1.0f) : vec2(1.0f, 0.0f);
    range = clip(range, from.x * tangent + sign * from.z + slack, to.x * tangent + sign * to.z + slack);
    range = clip(range, from.x + slack, to.x + slack);
    outline.segment[3 + side] = part_of(from, to, range);
  }
  return outline;
}

// How much further out than x a point of the slab may be.
FUNCTION float curvature_slack(IN(SlabOutline) outline, float tangent) {
  float farthest = 0.0f;
  for (int i = 0; i < 5; ++i) farthest = max(farthest, max(outline.segment[i].x, outline.segment[i].z));
  return farthest * (sqrt(1.0f + tangent * tangent) - 1.0f);
}

// Bounds of angle_order of φ over an outline; the first is larger than the second where nothing is there.
FUNCTION vec2 phi_order_bounds(IN(SlabOutline) outline, float slack) {
  vec2 bounds = vec2(3.0f, -1.0f);
  for (int i = 0; i < 5; ++i) {
    vec4 s = outline.segment[i];
    if (s.x >= 0.0f) {
      for (int end = 0; end < 2; ++end) {
        float x = end == 0 ? s.x : s.z;
        float w = end == 0 ? s.y : s.w;
        float inner = max(x - slack, 0.0f);
        float outer = x + slack;
        bounds.x = min(bounds.x, min(angle_order(inner, w + slack), angle_order(outer, w + slack)));
        bounds.y = max(bounds.y, max(angle_order(inner, w - slack), angle_order(outer, w - slack)));
      }
    }
  }
  return bounds;
}

// The least angle_order of α over the part of an outline between two light rays, given by cosine and sine of their φ; 3 where
// nothing is there.
FUNCTION float least_alpha_order(IN(SlabOutline) outline, IN(vec2) from_ray, IN(vec2) to_ray, float light_distance,
                                 float slack) {
  float least = 3.0f;
  for (int i = 0; i < 5; ++i) {
    vec4 s = outline.segment[i];
    vec2 range = clip(vec2(0.0f, 1.0f), s.x * from_ray.x - s.y * from_ray.y + slack, s.z * from_ray.x - s.w * from_ray.y + slack);
    range = clip(range, s.y * to_ray.y - s.x * to_ray.x + slack, s.w * to_ray.y - s.z * to_ray.x + slack);
    if (s.x >= 0.0f && range.x <= range.y) {
      for (int end = 0; end < 2; ++end) {
        float t = end == 0 ? range.x : range.y;
        float x = s.x + t * (s.z - s.x);
        float z = light_distance - (s.y + t * (s.w - s.y));
        float nearer = z + slack > 0.0f ? max(x - slack, 0.0f) : x + slack;
        least = min(least, angle_order(nearer, z + slack));
      }
    }
  }
  return least;
}

// A triangle in epipolar space.
struct VoxelTriangle {
  vec3 a, b, c;  // corners: coordinates along u, f and the axis, relative to the eye [m]
  float slack;   // [m]
  PlaneSpan planes;
};

// From the corners relative to the eye, along the world's axes.
FUNCTION VoxelTriangle voxel_triangle(IN(EpipolarBlock) space, IN(vec3) a, IN(vec3) b, IN(vec3) c, uint theta_count) {
  VoxelTriangle triangle;
  triangle.a = vec3(dot(a, space.u), dot(a, space.f), dot(a, space.axis));
  triangle.b = vec3(dot(b, space.u), dot(b, space.f), dot(b, space.axis));
  triangle.c = vec3(dot(c, space.u), dot(c, space.f), dot(c, space.axis));
  triangle.slack = position_slack(space, a, b, c);
  triangle.planes = planes_of_triangle(space, vec2(triangle.a.x, triangle.a.y), vec2(triangle.b.x, triangle.b.y),
                                       vec2(triangle.c.x, triangle.c.y), triangle.slack, theta_count);
  return triangle;
}

// The part of a triangle in a slab.
struct SlabPart {
  SlabOutline outline;
  float slack;
  uint first_ray;  // the cells of φ that it may touch: from here …
  uint end_ray;    // … to before here
};

FUNCTION vec3 seen_along_slab(IN(EpipolarBlock) space, IN(vec3) corner, float cosine, float sine) {
  return vec3(corner.x * cosine + corner.y * sine, space.distance - corner.z, corner.y * cosine - corner.x * sine);
}

// The slab between two angles θ from the middle of the range.
FUNCTION SlabPart part_in_slab(IN(EpipolarBlock) space, IN(PhiCells) cells, IN(VoxelTriangle) triangle, float from,
                               float to) {
  float theta = space.theta_middle + 0.5f * (from + to);
  float cosine = cos(theta);
  float sine = sin(theta);
  // The inverse of the planes' spacing is right to 1e-6.
  float tangent = tan(0.5f * (to - from) + 1e-6f);
  SlabPart part;
  part.outline = outline_in_slab(seen_along_slab(space, triangle.a, cosine, sine),
                                 seen_along_slab(space, triangle.b, cosine, sine),
                                 seen_along_slab(space, triangle.c, cosine, sine), tangent, triangle.slack);
  part.slack = triangle.slack + curvature_slack(part.outline, tangent);
  vec2 orders = phi_order_bounds(part.outline, part.slack);
  // Angles and cells are rounded too.
  float first = floor(cell_of_phi(cells, angle_from_order(max(orders.x, 0.0f))) - 1e-3f);
  float last = floor(cell_of_phi(cells, angle_from_order(clamp(orders.y, 0.0f, 2.0f))) + 1e-3f);
  part.first_ray = uint(clamp(first, 0.0f, cells.count));
  part.end_ray = orders.x > orders.y ? 0u : uint(clamp(last + 1.0f, 0.0f, cells.count));
  return part;
}

// Cosine and sine of φ at a boundary of cells.
FUNCTION vec2 boundary_ray(IN(PhiCells) cells, uint k) {
  float phi = phi_of_cell(cells, float(k));
  return vec2(cos(phi), sin(phi));
}

// The cell in α nearest the light that the part touches between two light rays; N_α if none.
FUNCTION uint first_touched_cell(IN(EpipolarBlock) space, IN(SlabPart) part, IN(vec2) from_ray, IN(vec2) to_ray,
                                 uint alpha_count) {
  float order = least_alpha_order(part.outline, from_ray, to_ray, space.distance, part.slack);
  // An order is rounded to 1e-7 of 2.
  float alpha = angle_from_order(clamp(order - 1e-6f, 0.0f, 2.0f));
  float i = floor((alpha - space.alpha_min) / space.alpha_step);
  return order > 2.0f ? alpha_count : uint(clamp(i, 0.0f, float(alpha_count)));
}

#endif
