#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "shared.h"
#include "support/random.h"

namespace airlight::shaders {
#include "frame/occlusion.glsl"
}  // namespace airlight::shaders

/// The predicate of surface shadows, on the CPU.
namespace airlight::shaders {
namespace {

const LightRays k_lamp = {vec3(0.0f), false};

Occluder turned(const LightRays& rays, const vec3& a, const vec3& b, const vec3& c) {
  return turn_of(rays, a, b, c) > 0.0f ? Occluder{a, b, c} : Occluder{a, c, b};
}

TEST(Occlusion, IsBeyondTheTriangleAndWithinItsSides) {
  const Occluder triangle = turned(k_lamp, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2});
  EXPECT_TRUE(hides(k_lamp, triangle, {0, 0, 2.1f}));
  EXPECT_TRUE(hides(k_lamp, triangle, {0, 0, 1e6f}));
  EXPECT_FALSE(hides(k_lamp, triangle, {0, 0, 2})) << "on it";
  EXPECT_FALSE(hides(k_lamp, triangle, {0, 0, 1.9f})) << "before it";
  EXPECT_FALSE(hides(k_lamp, triangle, {0, 0, -3})) << "behind the light";
  EXPECT_TRUE(hides(k_lamp, triangle, {0, -2, 4})) << "beyond an edge";
  EXPECT_TRUE(hides(k_lamp, triangle, {-2, -2, 4})) << "beyond a corner";
  EXPECT_FALSE(hides(k_lamp, triangle, {0, std::nextafter(-2.0f, -3.0f), 4})) << "an ulp beside";
}

TEST(Occlusion, OfASunIsAlongItsLight) {
  const LightRays sun = {vec3(0, -1, 0), true};
  const Occluder triangle = turned(sun, {-1, 5, -1}, {1, 5, -1}, {0, 5, 1});
  EXPECT_TRUE(hides(sun, triangle, {0, 0, 0}));
  EXPECT_FALSE(hides(sun, triangle, {0, 6, 0})) << "before it";
  EXPECT_FALSE(hides(sun, triangle, {0, 5, 0})) << "on it";
  EXPECT_TRUE(hides(sun, triangle, {0, -1e5f, -1})) << "beyond an edge";
  EXPECT_FALSE(hides(sun, triangle, {0, 0, std::nextafter(-1.0f, -2.0f)}));
}

TEST(Occlusion, OfATriangleSeenEdgeOnIsNone) {
  EXPECT_EQ(turn_of(k_lamp, {1, 0, 2}, {2, 0, 2}, {1, 0, 3}), 0.0f);
  EXPECT_EQ(turn_of({vec3(0, -1, 0), true}, {1, 0, 2}, {1, 1, 2}, {1, 5, 3}), 0.0f);
  // The plane through the origin whose normal is (1, 3, −7) holds corners that doubles have to cancel.
  EXPECT_EQ(turn_of(k_lamp, {3e5f, 4e5f, 2142857.25f}, {6e5f, 8e5f, 2 * 2142857.25f}, {1, 2, 1}), 0.0f)
      << "in line";
}

TEST(Occlusion, OfNeighboursLeavesNoGapAtTheirEdge) {
  tests::Random random(3);
  int close = 0;
  for (int i = 0; i < 200000; ++i) {
    const LightRays rays = {vec3(random.direction()), i % 2 == 0};
    const vec3 p = vec3(random.logarithmic(0.1, 10) * random.direction());
    const vec3 q = p + vec3(random.logarithmic(1e-3, 1) * random.direction());
    // A point as near to the edge's plane as rounding lets it be.
    const float share = static_cast<float>(random.uniform(0.01, 0.99)),
                far = static_cast<float>(random.uniform(1, 3));
    const vec3 on_edge = p + share * (q - p);
    const vec3 point = rays.is_sun ? on_edge + far * rays.travels : far * on_edge;
    const float side = side_of_edge(rays, p, q, point);
    EXPECT_EQ(side, -side_of_edge(rays, q, p, point));
    close +=
        side == determinant_sign_32(rays.is_sun ? rays.travels : p, q - p, rays.is_sun ? point - p : point)
            ? 0
            : 1;
  }
  EXPECT_GT(close, 1000) << "cases that single precision cannot tell";
}

/// Fans of triangles about corners: a sphere of 8 · 16 · 16 right triangles on a grid of round numbers, so
/// that points can be in line with its edges and corners exactly.
std::vector<std::array<vec3, 3>> round_ball() {
  constexpr int k_cells = 4;
  std::vector<std::array<vec3, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      for (int i = 0; i < 2 * k_cells * k_cells * 2; ++i) {
        const int u = i / 2 % (2 * k_cells) - k_cells, v = i / 2 / (2 * k_cells) * 2 - k_cells;
        const auto at = [&](int du, int dv) {
          vec3 corner(0.0f);
          corner[axis] = side * k_cells;
          corner[(axis + 1) % 3] = static_cast<float>(u + du);
          corner[(axis + 2) % 3] = static_cast<float>(v + dv);
          return corner;
        };
        std::array<vec3, 3> triangle =
            i % 2 == 0 ? std::array{at(0, 0), at(1, 0), at(1, 2)} : std::array{at(0, 0), at(1, 2), at(0, 2)};
        if (side < 0) std::swap(triangle[1], triangle[2]);
        triangles.push_back(triangle);
      }
    }
  }
  return triangles;
}

/// How often the way to a point crosses triangles from their backs, and from their fronts.
glm::ivec2 crossings(const LightRays& rays, const std::vector<std::array<vec3, 3>>& triangles,
                     const vec3& point) {
  glm::ivec2 count(0);
  for (const auto& [a, b, c] : triangles) {
    const float turn = turn_of(rays, a, b, c);
    if (turn != 0.0f && crosses(rays, turned(rays, a, b, c), point)) ++count[turn > 0.0f ? 0 : 1];
  }
  return count;
}

TEST(Crossings, OfASheetAreOneThroughEdgesAndCorners) {
  const auto ball = round_ball();
  int touched = 0;
  for (const auto& [a, b, c] : ball) {
    for (const vec3& target : {a, b, c, (a + b) / 2.0f, (b + c) / 2.0f, (c + a) / 2.0f, (a + b + c) / 4.0f}) {
      EXPECT_EQ(crossings(k_lamp, ball, 3.0f * target), glm::ivec2(1, 0)) << target.x << target.y << target.z;
      for (const auto& [d, e, f] : ball) touched += hides(k_lamp, turned(k_lamp, d, e, f), 3.0f * target);
    }
  }
  EXPECT_GT(touched, 2 * 7 * static_cast<int>(ball.size())) << "most of them touch several triangles";
}

TEST(Crossings, OfASolidAreAsManyInAsOut) {
  const auto ball = round_ball();
  tests::Random random(4);
  for (int i = 0; i < 40; ++i) {
    // Directions and lamps on which corners and edges line up, and others.
    const bool is_round = i % 2 == 0;
    const vec3 travels = is_round ? vec3(i / 2 % 3 - 1, i / 6 % 3 - 1, 1) : vec3(random.direction());
    const LightRays sun = {travels, true};
    const vec3 lamp = is_round ? vec3(i % 5 - 2, 3 * (i % 3), 12) : 12.0f * vec3(random.direction());
    auto moved = ball;
    for (auto& triangle : moved)
      for (vec3& corner : triangle) corner -= lamp;
    glm::ivec2 by_sun(0), by_lamp(0);
    for (std::size_t t = 0; t < ball.size(); t += 3) {
      const vec3& corner = ball[t][0];
      const glm::ivec2 sun_count = crossings(sun, ball, corner + 100.0f * travels),
                       lamp_count = crossings(k_lamp, moved, 64.0f * moved[t][0]);
      EXPECT_EQ(sun_count.x, sun_count.y) << i << ", " << t;
      EXPECT_EQ(lamp_count.x, lamp_count.y) << i << ", " << t;
      EXPECT_LE(std::max(sun_count.x, lamp_count.x), 1);
      by_sun += sun_count;
      by_lamp += lamp_count;
    }
    EXPECT_GT(by_sun.x, 20);
    EXPECT_GT(by_lamp.x, 20);
  }
}

TEST(Determinant, InSinglePrecisionIsRightOrSaysNothing) {
  tests::Random random(7);
  int unsure = 0, sure = 0;
  for (int i = 0; i < 300000; ++i) {
    const vec3 a = vec3(random.direction()), b = vec3(random.logarithmic(1e-6, 1e3) * random.direction());
    // Nearly in the plane of a and b.
    const glm::dvec3 in_plane = random.uniform(-1, 1) * glm::dvec3(a) + random.uniform(-1, 1) * glm::dvec3(b);
    const vec3 c = vec3(in_plane + random.logarithmic(1e-12, 1e-3) * random.direction());
    const glm::dvec3 da(a), db(b), dc(c);
    using Long = long double;
    const auto product = [](double x, double y, double z) { return Long(x) * Long(y) * Long(z); };
    const Long exact = (product(da.x, db.y, dc.z) - product(da.x, db.z, dc.y)) +
                       (product(da.y, db.z, dc.x) - product(da.y, db.x, dc.z)) +
                       (product(da.z, db.x, dc.y) - product(da.z, db.y, dc.x));
    const float single = determinant_sign_32(a, b, c);
    const float in_double = determinant_sign_64(da, db, dc);
    unsure += single == 0.0f;
    sure += single != 0.0f;
    const bool is_above = exact > 0;
    EXPECT_TRUE(single == 0.0f || (single > 0.0f) == is_above) << i;
    EXPECT_TRUE(in_double == 0.0f || (in_double > 0.0f) == is_above) << i;
  }
  EXPECT_GT(unsure, 10000);
  EXPECT_GT(sure, 10000);
}

TEST(PartsEyeFromLight, WhereTheyAreOnEitherSide) {
  const vec3 a(-1, -1, 2), b(1, -1, 2), c(0, 1, 2);
  for (const bool is_turned : {false, true}) {
    const vec3 p = is_turned ? c : b, q = is_turned ? b : c;
    EXPECT_FALSE(parts_eye_from_light(k_lamp, a, p, q, {5, 0, 1}));
    EXPECT_TRUE(parts_eye_from_light(k_lamp, a, p, q, {5, 0, 3}));
    EXPECT_FALSE(parts_eye_from_light(k_lamp, a, p, q, {5, 0, 2})) << "in the plane";
    const LightRays sun = {vec3(0, 0.1f, 1), true};
    EXPECT_FALSE(parts_eye_from_light(sun, a, p, q, {0, 0, 0}));
    EXPECT_TRUE(parts_eye_from_light(sun, a, p, q, {0, 0, 5}));
  }
}

}  // namespace
}  // namespace airlight::shaders
