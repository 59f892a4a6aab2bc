// Which voxels a triangle touches.
//
// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, sections 4.1.1 and 4.1.2; and what it takes from Schwarz and
// Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia 2010.
// Deviation: nothing is split. The triangle is cut by the two half-planes that bound one cell of θ, its slab, one cell after
// another, so that a triangle may wrap over θ = ±π, hold the epipole or pass behind the eye or the light. And no
// edge is taken to be straight that is not: seen along the slab (coordinates z along the axis, x outwards), lines are lines,
// and the cells of α and φ are bounded by lines through the eye and the light; a sun's light rays are lines too, x = s. What is
// left of the curvature, that x = ρ cos(θ − θ_j) stands for the distance ρ from the axis, is bounded by x ≤ ρ ≤ x / cos(half a slab).
//
// All lengths and angles carry a slack, the most that arithmetic misplaces them; it makes the result larger, never smaller. It
// covers any arithmetic that GLSL allows (arithmetic.glsl): with e = 2⁻²³, sums and products are right to e, quotients to 2.5 e,
// square roots to 4.5 e, sine and cosine to 2 e, angle_of to 10 e, and sums may be taken in any order, with products fused into
// them or not. M is the largest of the lengths from the eye to the corners and to the light, a sun left out.
//   positions  A corner's coordinates are right to 6 e M; turned into a slab, to 13 e M across the axis and 8 e M along it; where
//              an edge, up to 2 M long, is clipped, to 25 e M, and to 30 e M across a light ray; clipped again between two light
//              rays, to 37 e M. A distance from a light ray takes 7 e M more.
//   light rays The direction of a boundary of cells is right to 31 e, at φ = π, and 3 e for sine and cosine; a sun's s, to 10 e of it.
//   θ          A border of cells is the solution of an equation that is right to 16 e, whose slope is that of the spacing, at least
//              1 − g. The middle of a slab and its ends, sums of angles up to 2π, take 20 e more. The angle of a corner from
//              the middle of the range is right to 55 e, the plane at an angle, times the spacing's step, to 28 e.
//   orders     angle_order is right to 6 e, angle_from_order to 14 e, and angles are between once and twice their order. What
//              orders a sun's light rays is a position, x, and has its slack alone.
//   cells      place_of_phi is right to 18 e of the place, at most 1, cell_of_phi, times a cell's share of the places, to 4 e more; a
//              cell of α, times its width, to 11 e.
#ifndef AIRLIGHT_CONSERVATIVE_GLSL
#define AIRLIGHT_CONSERVATIVE_GLSL
#include "epipolar/grid.glsl"

// No slab is wider than this, so that tan and 1/cos of its half stay small: a wide cell of θ is cut into several.
CONST Angle k_widest_slab = Angle(0.2f);

// How many slabs a cell of θ has; at most 158 (θ steps are at most 2π, g at most 0.8, epipolar/space.cpp).
FUNCTION uint slabs_per_plane(IN(EpipolarBlock) space) {
  return uint(ceil(space.theta_step / ((1.0f - space.theta_growth) * k_widest_slab)));
}

// Of positions, relative to M: 38 e.
CONST float k_position_slack = 5e-6f;
// Of the directions of light rays [rad]: 34 e.
CONST float k_ray_slack = 5e-6f;
// Of the borders of slabs, over the density of planes: 16 e over the density and 20 e, which is at most twice as dense.
CONST Angle k_border_slack = Angle(7e-6f);
// Of an angle θ on the way to its plane, over 1 − g: 55 e and 28 e over 1 − g.
CONST Angle k_theta_slack = Angle(1e-5f);
// Of orders: 6 e, 14 e and, for α, 11 e.
CONST Order k_order_slack = Order(4e-6f);
// Of the number of cells in α: 5 e and, of roots, 5 e more.
CONST float k_row_slack = 2e-6f;
// Of places in the range of φ: 22 e.
CONST float k_cell_slack = 3e-6f;

// What arithmetic may misplace a point of the triangle by [m].
FUNCTION float position_slack(IN(EpipolarBlock) space, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  float largest = max(dot(a, a), max(dot(b, b), dot(c, c)));
  return k_position_slack * max(sqrt(largest), space.distance);
}

// The least distance from the origin to the segment (a, b).
FUNCTION float distance_to_segment(IN(vec2) a, IN(vec2) b) {
  vec2 along = b - a;
  float t = clamp(-dot(a, along) / max(dot(along, along), 1e-37f), 0.0f, 1.0f);
  return length(a + t * along);
}

// An angle in (−2π, 2π) as one in [−π, π].
FUNCTION Angle wrapped(Angle angle) {
  return angle > k_half_turn ? angle - 2.0f * k_half_turn : angle < -k_half_turn ? angle + 2.0f * k_half_turn : angle;
}

// The planes whose cells a triangle may touch: two runs, the second one for what wraps over the end of a full turn.
struct PlaneSpan {
  uint first;
  uint count;
  uint wrapped_first;
  uint wrapped_count;
};

FUNCTION uint clamped_plane(IN(EpipolarBlock) space, Angle from_middle, uint theta_count) {
  Cell plane = floor(plane_of_theta(space, clamp(from_middle, -k_half_turn, k_half_turn)));
  return uint(clamp(plane, Cell(0.0f), Cell(float(theta_count) - 1.0f)));
}

// `a`, `b`, `c`: the corners' coordinates along u and f, from the axis. `slack` [m].
FUNCTION PlaneSpan planes_of_triangle(IN(EpipolarBlock) space, IN(vec2) a, IN(vec2) b, IN(vec2) c, float slack,
                                      uint theta_count) {
  // A triangle that holds the axis, or comes within twice the slack of it, is in every plane.
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

  // The range of θ, from the middle of the grid's. Seen along the axis, a triangle beside the origin spans less than π.
  Angle theta_a = angle_of(a.y, a.x);
  Angle to_b = wrapped(angle_of(b.y, b.x) - theta_a);
  Angle to_c = wrapped(angle_of(c.y, c.x) - theta_a);
  Angle margin = Angle(2.0f * slack / nearest) + k_theta_slack / (1.0f - space.theta_growth);
  Angle lower = wrapped(theta_a - space.theta_middle) + min(Angle(0.0f), min(to_b, to_c)) - margin;
  Angle upper = wrapped(theta_a - space.theta_middle) + max(Angle(0.0f), max(to_b, to_c)) + margin;
  // Let it start in [−π, π]; it may end in the next turn.
  Angle turn = lower < -k_half_turn ? 2.0f * k_half_turn : Angle(0.0f);
  lower += turn;
  upper += turn;
  // The planes of this turn, and those of the next.
  span.count = 0u;
  if (lower <= space.theta_half && upper >= -space.theta_half) {
    span.first = clamped_plane(space, lower, theta_count);
    span.count = clamped_plane(space, upper, theta_count) - span.first + 1u;
  }
  if (upper - 2.0f * k_half_turn >= -space.theta_half) {
    span.wrapped_first = clamped_plane(space, lower - 2.0f * k_half_turn, theta_count);
    span.wrapped_count = clamped_plane(space, upper - 2.0f * k_half_turn, theta_count) - span.wrapped_first + 1u;
  }
  return span;
}

FUNCTION uint plane_count(IN(PlaneSpan) span) { return span.count + span.wrapped_count; }

// The `index`th plane of a span.
FUNCTION uint plane_at(IN(PlaneSpan) span, uint index) {
  return index < span.count ? span.first + index : span.wrapped_first + (index - span.count);
}

// The outline of the part of a triangle in a slab, seen along it: segments (x, w) to (x, w), with x outwards from the
// axis and w along it, from the light towards the eye; of a sun, from the eye away from the sun. A segment that is not there has
// x < 0.
struct SlabOutline {
  vec4 segment[5];
};

// Keeps the part of [range.x, range.y] ⊂ [0, 1] where a linear function is not negative, f_0 at 0 and f_1 at 1. None is left
// where range.x > range.y. Values of opposite sign must not both be so small that a GPU may flush them to 0; sums with a
// slack are not.
FUNCTION vec2 clip(IN(vec2) range, float f_0, float f_1) {
  float root = f_0 / (f_0 - f_1);  // used only where the signs differ
  float lower = f_0 < 0.0f ? (f_1 < 0.0f ? 2.0f : root) : 0.0f;
  float upper = f_1 < 0.0f ? (f_0 < 0.0f ? -1.0f : root) : 1.0f;
  return vec2(max(range.x, lower), min(range.y, upper));
}

// The part of the edge (a, b), given as in outline_in_slab, as a segment of the outline.
FUNCTION vec4 part_of(IN(vec3) a, IN(vec3) b, IN(vec2) range) {
  if (range.x > range.y) return vec4(-1.0f);
  vec3 from = a + range.x * (b - a);
  vec3 to = a + range.y * (b - a);
  return vec4(max(from.x, 0.0f), from.y, max(to.x, 0.0f), to.y);
}

// `a`, `b`, `c`: the corners as (x, w, y), with y at right angles to the slab's middle plane. `tangent`: of half
// the slab's angle.
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
    // The chord along this side: from the first edge that crosses it to the last.
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
    // What of it lies before the other side and outwards from the axis.
    vec2 range = is_cut ? vec2(0.0f, 1.0f) : vec2(1.0f, 0.0f);
    range = clip(range, from.x * tangent + sign * from.z + slack, to.x * tangent + sign * to.z + slack);
    range = clip(range, from.x + slack, to.x + slack);
    outline.segment[3 + side] = part_of(from, to, range);
  }
  return outline;
}

// How much further out than x a point of the slab may be: x (√(1 + tan²) − 1) ≤ x tan² / 2.
FUNCTION float curvature_slack(IN(SlabOutline) outline, float tangent) {
  float farthest = 0.0f;
  for (int i = 0; i < 5; ++i) farthest = max(farthest, max(outline.segment[i].x, outline.segment[i].z));
  return 0.5f * farthest * tangent * tangent;
}

// The least and the largest order (phi_order_at) of φ over an outline: φ is extreme where its segments end. The first is larger than
// the second where nothing is there.
FUNCTION vec2 phi_order_bounds(IN(EpipolarBlock) space, IN(SlabOutline) outline, float slack) {
  vec2 bounds = vec2(1e30f, -1.0f);
  for (int i = 0; i < 5; ++i) {
    vec4 s = outline.segment[i];
    if (s.x >= 0.0f) {
      for (int end = 0; end < 2; ++end) {
        float x = end == 0 ? s.x : s.z;
        float w = end == 0 ? s.y : s.w;
        float inner = max(x - slack, 0.0f);
        float outer = x + slack;
        if (is_sun(space)) {
          bounds = vec2(min(bounds.x, inner), max(bounds.y, outer));
        } else {
          bounds.x = min(bounds.x, float(min(angle_order(inner, w + slack), angle_order(outer, w + slack))));
          bounds.y = max(bounds.y, float(max(angle_order(inner, w - slack), angle_order(outer, w - slack))));
        }
      }
    }
  }
  return bounds;
}

// A boundary of cells of φ: how far beyond it a point (x, w) lies is ray.x · x − ray.y · w − ray.z [m]. A lamp's light ray leads from
// (0, 0) along (sin φ, cos φ), a sun's is parallel to the axis.
FUNCTION vec3 boundary_ray(IN(EpipolarBlock) space, IN(PhiCells) cells, uint k) {
  Angle phi = phi_of_cell(cells, Cell(float(k)));
  return is_sun(space) ? vec3(1.0f, 0.0f, float(phi)) : vec3(cosine(phi), sine(phi), 0.0f);
}

FUNCTION float distance_beyond(IN(vec3) ray, float x, float w) { return x * ray.x - w * ray.y - ray.z; }

// The least angle_order of α over the part of an outline between two light rays; 3 where nothing is there.
FUNCTION Order least_alpha_order(IN(EpipolarBlock) space, IN(SlabOutline) outline, IN(vec3) from_ray, IN(vec3) to_ray,
                                 float slack) {
  Order least = Order(3.0f);
  for (int i = 0; i < 5; ++i) {
    vec4 s = outline.segment[i];
    // The part of the segment between the two rays. From where a lamp's start, (0, 0), it is no farther than |x| + |w|; a sun's s
    // is no larger than x.
    float from_slack = slack + k_ray_slack * (s.x + abs(s.y));
    float to_slack = slack + k_ray_slack * (s.z + abs(s.w));
    vec2 range = clip(vec2(0.0f, 1.0f), distance_beyond(from_ray, s.x, s.y) + from_slack,
                      distance_beyond(from_ray, s.z, s.w) + to_slack);
    range = clip(range, from_slack - distance_beyond(to_ray, s.x, s.y), to_slack - distance_beyond(to_ray, s.z, s.w));
    // α is extreme at its ends; z is along the axis from the eye.
    if (s.x >= 0.0f && range.x <= range.y) {
      for (int end = 0; end < 2; ++end) {
        float t = end == 0 ? range.x : range.y;
        float x = s.x + t * (s.z - s.x);
        float z = space.distance - (s.y + t * (s.w - s.y));
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
  float slack;     // of its points [m]
  uint first_ray;  // the cells of φ that it may touch: from here …
  uint end_ray;    // … to before here
};

// A corner, relative to the eye, as outline_in_slab takes it: outwards in the slab's middle plane, along the axis (SlabOutline), and at
// right angles to that plane.
FUNCTION vec3 seen_along_slab(IN(EpipolarBlock) space, IN(vec3) corner, float cosine, float sine) {
  return vec3(corner.x * cosine + corner.y * sine, space.distance - corner.z, corner.y * cosine - corner.x * sine);
}

// The slab between two angles θ from the middle of the range.
FUNCTION SlabPart part_in_slab(IN(EpipolarBlock) space, IN(PhiCells) cells, IN(VoxelTriangle) triangle, Angle from,
                               Angle to) {
  // The slab: its middle plane, and half its angle with the slack of its borders.
  Angle middle = 0.5f * (from + to);
  float cos_theta = cosine(space.theta_middle + middle);
  float sin_theta = sine(space.theta_middle + middle);
  Angle half_angle = 0.5f * (to - from) + k_border_slack / (1.0f + space.theta_growth * cosine(middle));
  float tangent = sine(half_angle) / cosine(half_angle);
  // What of the triangle is in it.
  SlabPart part;
  part.outline = outline_in_slab(seen_along_slab(space, triangle.a, cos_theta, sin_theta),
                                 seen_along_slab(space, triangle.b, cos_theta, sin_theta),
                                 seen_along_slab(space, triangle.c, cos_theta, sin_theta), tangent, triangle.slack);
  part.slack = triangle.slack + curvature_slack(part.outline, tangent);
  // The cells of φ that this spans.
  vec2 orders = phi_order_bounds(space, part.outline, part.slack);
  Order order_slack = is_sun(space) ? Order(0.0f) : k_order_slack;
  Cell cell_slack = Cell(k_cell_slack / cells.per_cell);
  Cell first = floor(cell_of_phi(cells, phi_from_order(space, Order(orders.x) - order_slack)) - cell_slack);
  Cell last = floor(cell_of_phi(cells, phi_from_order(space, Order(orders.y) + order_slack)) + cell_slack);
  part.first_ray = uint(clamp(first, Cell(0.0f), cells.count));
  part.end_ray = orders.x > orders.y ? 0u : uint(clamp(last + Cell(1.0f), Cell(0.0f), cells.count));
  return part;
}

// The cell in α nearest the light that the part touches between two light rays; N_α if none.
FUNCTION uint first_touched_cell(IN(EpipolarBlock) space, IN(SlabPart) part, IN(vec3) from_ray, IN(vec3) to_ray,
                                 uint alpha_count) {
  Order order = least_alpha_order(space, part.outline, from_ray, to_ray, part.slack);
  Angle alpha = angle_from_order(clamp(order - k_order_slack, Order(0.0f), Order(2.0f)));
  float i = floor(float(cell_of_alpha(space, alpha)) - k_row_slack * float(alpha_count));
  // An order may be rounded to a little more than 2; 3 says that nothing is there.
  return order > Order(2.5f) ? alpha_count : uint(clamp(i, 0.0f, float(alpha_count)));
}

#endif
