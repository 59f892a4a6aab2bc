#version 450
#extension GL_GOOGLE_include_directive : require

// Flips the bits of the grid at each crossing of a surface.
//
// Seen from the eye, (α, θ) is a screen whose pixels are the rows of the grid, each with a view ray of its own. A surface that
// the ray crosses turns inside to outside for all that lies before it, that is, flips the bits up to the crossing. Only the
// last of those bits is flipped here; screen_space_resolve.comp flips the others.
//
// A crossing must be found by exactly one of the triangles that meet at an edge. Which side of an edge a ray passes is
// therefore decided from the edge's two corners alone, taken in an order that does not depend on the triangle, and by sums and
// products alone that are PRECISE: all passes, programs of their own, must come to the same bits.
#include "epipolar/uniforms.glsl"
#include "epipolar/conservative.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/window.glsl"
#include "epipolar/phi_range.glsl"
#define TRIANGLE ScreenTriangle
#include "epipolar/triangle_queue.glsl"

layout(std430, binding = k_scratch_storage) buffer Flips { uint flips[]; };  // as the grid's window, by words

vec3 corner(uint index) {
  vec3 p = eye_relative(camera, texelFetch(positions, int(index)).xyz);
  return vec3(ordered_dot(p, space.u), ordered_dot(p, space.f), ordered_dot(p, space.axis));
}

struct Edge {
  vec3 normal;      // of the plane through the eye and the edge
  bool is_reversed; // the triangle goes along it against its order
};

Edge make_edge(vec3 a, vec3 b) {
  Edge edge;
  edge.is_reversed = a.x != b.x ? a.x > b.x : a.y != b.y ? a.y > b.y : a.z > b.z;
  vec3 p = edge.is_reversed ? b : a;
  vec3 q = edge.is_reversed ? a : b;
  PRECISE vec3 normal = p.yzx * q.zxy - p.zxy * q.yzx;
  edge.normal = normal;
  return edge;
}

bool is_left(Edge edge, vec3 ray) {
  return (ordered_dot(edge.normal, ray) > 0.0) != edge.is_reversed;
}

struct ScreenTriangle {
  vec3 a, b, c;  // coordinates along u, f and the axis, relative to the eye [m]
  float slack;   // [m]
  Edge ab, bc, ca;
  PlaneSpan planes;
};

ScreenTriangle fetch_triangle(uint index) {
  uvec3 corners = texelFetch(triangles, int(index)).xyz;
  ScreenTriangle t;
  t.a = corner(corners.x);
  t.b = corner(corners.y);
  t.c = corner(corners.z);
  t.slack = position_slack(space, t.a, t.b, t.c);
  t.ab = make_edge(t.a, t.b);
  t.bc = make_edge(t.b, t.c);
  t.ca = make_edge(t.c, t.a);
  t.planes = planes_of_triangle(space, t.a.xy, t.b.xy, t.c.xy, t.slack, k_theta_count);
  return t;
}

// Bounds of α where the triangle meets a half-plane; the first is larger than the second where it does not.
vec2 alpha_bounds(ScreenTriangle t, float cosine, float sine) {
  vec3 corners[4] = vec3[4](t.a, t.b, t.c, t.a);
  vec2 bounds = vec2(4.0, -1.0);
  for (int i = 0; i < 3; ++i) {
    vec3 p = corners[i];
    vec3 q = corners[i + 1];
    float y_p = p.y * cosine - p.x * sine;
    float y_q = q.y * cosine - q.x * sine;
    // The part of the edge within the slack of the half-plane's plane.
    vec2 range = clip(vec2(0.0, 1.0), t.slack - y_p, t.slack - y_q);
    range = clip(range, t.slack + y_p, t.slack + y_q);
    for (int end = 0; end < 2; ++end) {
      vec3 point = p + (end == 0 ? range.x : range.y) * (q - p);
      float x = point.x * cosine + point.y * sine;
      if (range.x <= range.y) {
        // A triangle that reaches beyond the axis crosses it, before the eye or behind.
        float alpha = angle_of(x, point.z);
        bounds = vec2(min(bounds.x, x > 0.0 ? alpha : 0.0), max(bounds.y, x > 0.0 ? alpha : k_pi));
      }
    }
  }
  return bounds;
}

// α of a row, at the centre of its cell.
EyeAngle row_angle(uint i) {
  PRECISE float alpha = alpha_of_cell(space, float(i) + 0.5);
  return EyeAngle(sine(alpha), cosine(alpha));
}

// The row's view ray, along u, f and the axis.
vec3 row_ray(EyeAngle angle, float plane_cosine, float plane_sine) {
  PRECISE vec3 ray = vec3(angle.sine * plane_cosine, angle.sine * plane_sine, angle.cosine);
  return ray;
}

// Flips a bit for each row of the triangle's `index`th plane whose view ray crosses it.
void voxelize_in_plane(ScreenTriangle t, uint index) {
  uint j = plane_at(t.planes, index);
  float plane_cosine = plane_direction(j).x;
  float plane_sine = plane_direction(j).y;
  vec2 bounds = alpha_bounds(t, plane_cosine, plane_sine);
  uint first = uint(max(int(alpha_cell(space, bounds.x, k_alpha_count)) - 1, 0));
  uint end = bounds.x > bounds.y ? 0u : min(alpha_cell(space, bounds.y, k_alpha_count) + 2u, k_alpha_count);
  uint plane = j - window_first_plane;
  if (j < window_first_plane || plane >= window_planes) end = 0u;
  PhiCells cells = phi_cells(j);
  for (uint i = first; i < end; ++i) {
    EyeAngle angle = row_angle(i);
    vec3 ray = row_ray(angle, plane_cosine, plane_sine);
    bool left = is_left(t.ab, ray);
    vec3 normal = cross(t.b - t.a, t.c - t.a);
    bool is_ahead = (dot(normal, t.a) > 0.0) == (dot(normal, ray) > 0.0);
    if (left == is_left(t.bc, ray) && left == is_left(t.ca, ray) && is_ahead) {
      float distance = ray_triangle_distance(ray, t.a, t.b, t.c);
      // Cells whose centre lies before the crossing.
      float before = ceil(cell_of_phi(cells, phi_at(space, angle, distance)) - 0.5);
      uint count = uint(clamp(before, 0.0, cells.count));
      if (count > 0u) {
        uint bit = count - 1u;
        atomicXor(flips[grid_word(i, plane, bit >> 5, k_alpha_count, k_words_per_ray)], 1u << (bit & 31u));
      }
    }
  }
}

#include "epipolar/triangle_passes.glsl"
