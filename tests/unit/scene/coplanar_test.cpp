#include "scene/coplanar.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace airlight::scene {
namespace {

using testing::Each;
using testing::ElementsAre;
using tests::add_quad;
using tests::add_triangle;

/// Adds a triangle in the plane y = height.
void add_level(Geometry& geometry, float height) {
  add_triangle(geometry, {0, height, 0}, {0, height, 1}, {1, height, 0});
}

std::size_t count_different(const std::vector<std::uint32_t>& planes) {
  return std::set(planes.begin(), planes.end()).size();
}

TEST(Coplanar, BoxHasSixPlanes) {
  Geometry geometry;
  tests::add_box(geometry, {-1, 2, -3}, {0.1f, 2.7f, 1e3f});
  EXPECT_THAT(planes_of(geometry), ElementsAre(0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5));
}

TEST(Coplanar, NoTrianglesAreNoPlanes) {
  EXPECT_THAT(planes_of({}), testing::IsEmpty());
}

TEST(Coplanar, CornersInAnyOrderAreOnePlane) {
  Geometry geometry;
  geometry.positions = {{0.1f, 0.2f, 0.3f}, {7.7f, -1.3f, 2.1f}, {-3.3f, 0.9f, 11.1f}};
  geometry.triangles = {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}, {1, 0, 2}, {0, 2, 1}};
  EXPECT_THAT(planes_of(geometry), Each(0u));
}

TEST(Coplanar, ParallelPlanesAnUlpApartDiffer) {
  Geometry geometry;
  for (const float height : {1.0f, std::nextafter(1.0f, 2.0f), std::nextafter(1.0f, 0.0f), -1.0f, 1.0f})
    add_level(geometry, height);
  EXPECT_THAT(planes_of(geometry), ElementsAre(0, 1, 2, 3, 0));

  geometry = {};
  const glm::vec3 u(1, 2, 3), v(-2, 1, 5);
  for (const float x : {8.0f, std::nextafter(8.0f, 9.0f), 8.0f})
    add_triangle(geometry, {x, 8, 8}, u + glm::vec3(x, 8, 8), v + glm::vec3(x, 8, 8));
  EXPECT_THAT(planes_of(geometry), ElementsAre(0, 1, 0));
}

TEST(Coplanar, CornerAnUlpAsideIsAnotherPlane) {
  Geometry geometry;
  for (const float z : {0.7f, std::nextafter(0.7f, 1.0f)})
    add_triangle(geometry, {0.1f, 0.2f, 0.3f}, {7.7f, -1.3f, 2.1f}, {-3.3f, 0.9f, z});
  EXPECT_THAT(planes_of(geometry), ElementsAre(0, 1));
}

TEST(Coplanar, NegativeZeroIsZero) {
  Geometry geometry;
  add_level(geometry, 0.0f);
  add_level(geometry, -0.0f);
  add_triangle(geometry, {-0.0f, 0, -0.0f}, {0, -0.0f, -1}, {-1, 0, 0});
  EXPECT_THAT(planes_of(geometry), Each(0u));
}

// Modulo a prime that is good for fast arithmetic, some power of 2 is a small number.
TEST(Coplanar, HeightsOfEveryExponentDiffer) {
  Geometry geometry;
  add_level(geometry, 0.0f);
  for (int exponent = -149; exponent <= 120; ++exponent) {
    for (int odd = -127; odd <= 127; odd += 2)
      add_level(geometry, std::ldexp(static_cast<float>(odd), exponent));
  }
  EXPECT_EQ(count_different(planes_of(geometry)), geometry.triangles.size());
}

TEST(Coplanar, SubnormalCornersAreWhereTheyAre) {
  Geometry geometry;
  for (const int exponent : {-149, -128, -127, -126, 0}) {
    const float x = std::ldexp(1.0f, exponent);
    add_triangle(geometry, {0, 0, 0}, {0, 0, 1}, {x, 2 * x, 0});
  }
  EXPECT_THAT(planes_of(geometry), Each(0u));
}

TEST(Coplanar, PlaneMayReachFromTinyToHuge) {
  const glm::vec3 a(1e30f, 0, 0), b(0, 1.1f, 0), c(0, 0, 1e-30f);
  const float up = std::numeric_limits<float>::infinity();
  Geometry geometry;
  add_triangle(geometry, a, b, c);
  add_triangle(geometry, 0.5f * a + 0.5f * b, 0.5f * b + 0.5f * c, 0.5f * c + 0.5f * a);
  add_triangle(geometry, a, b, {0, 0, std::nextafter(c.z, up)});
  add_triangle(geometry, a, {0, std::nextafter(b.y, up), 0}, c);
  add_triangle(geometry, {std::nextafter(a.x, up), 0, 0}, b, c);
  add_triangle(geometry, a, b, {0, 0, std::numeric_limits<float>::denorm_min()});
  add_triangle(geometry, a, b, {0, 0, 0});
  EXPECT_THAT(planes_of(geometry), ElementsAre(0, 0, 1, 2, 3, 4, 5));
}

TEST(Coplanar, TrianglesWithoutAPlaneHaveNumbersOfTheirOwn) {
  Geometry geometry;
  const glm::vec3 a(0.1f, 0.2f, 0.3f), b(3, 5, 7);
  add_level(geometry, 0.0f);
  add_triangle(geometry, a, a, a);
  add_triangle(geometry, a, a, b);
  add_triangle(geometry, a, b, a);
  add_triangle(geometry, {0, 0, 0}, b, 2.0f * b);
  add_triangle(geometry, {0, 0, 0}, b, 2.0f * b);
  add_level(geometry, 0.0f);
  add_triangle(geometry, {0, 0, 0}, b, {6, 10, std::nextafter(14.0f, 15.0f)});
  EXPECT_THAT(planes_of(geometry), ElementsAre(0, 1, 2, 3, 4, 5, 0, 6));
}

TEST(Coplanar, SlantedGridIsOnePlaneWhereverItIs) {
  for (const float away : {0.0f, 1000.0f, 1048576.0f}) {
    Geometry geometry;
    for (int i = -20; i < 20; ++i) {
      for (int j = -20; j < 20; ++j) {
        const glm::vec3 corner(i, j, 2 * i - 3 * j);
        add_quad(geometry, corner + away, {1, 0, 2}, {0, 1, -3});
      }
    }
    add_quad(geometry, glm::vec3(0, 0, 1) + away, {1, 0, 2}, {0, 1, -3});
    auto planes = planes_of(geometry);
    ASSERT_EQ(planes.size(), 2u * 1601);
    EXPECT_EQ(planes.back(), 1u);
    planes.resize(2 * 1600);
    EXPECT_THAT(planes, Each(0u)) << "at " << away;
  }
}

struct Integers {
  std::int64_t x, y, z;
  bool operator==(const Integers&) const = default;
};

Integers operator-(const Integers& a, const Integers& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

Integers cross(const Integers& a, const Integers& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

std::int64_t dot(const Integers& a, const Integers& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

TEST(Coplanar, AgreesWithIntegerArithmetic) {
  constexpr std::size_t k_count = 800;
  std::mt19937 random(7);
  for (const int reach : {1, 2, 40}) {
    // The unit is a power of 2, which keeps the floats integers times it.
    const float unit = std::ldexp(1.0f, reach == 1 ? -140 : reach == 2 ? 0 : 60);
    std::uniform_int_distribution<int> coordinate(-reach, reach);
    std::vector<std::array<Integers, 3>> triangles(k_count);
    Geometry geometry;
    for (auto& corners : triangles) {
      for (Integers& corner : corners) corner = {coordinate(random), coordinate(random), coordinate(random)};
      const auto position = [&](std::size_t i) {
        return unit * glm::vec3(corners[i].x, corners[i].y, corners[i].z);
      };
      add_triangle(geometry, position(0), position(1), position(2));
    }

    const auto planes = planes_of(geometry);
    ASSERT_EQ(planes.size(), k_count);
    const auto normal = [&](std::size_t t) {
      return cross(triangles[t][1] - triangles[t][0], triangles[t][2] - triangles[t][0]);
    };
    std::size_t wrong = 0, coplanar = 0, without = 0;
    for (std::size_t t = 0; t < k_count; ++t) {
      const Integers n = normal(t), none{};
      without += n == none ? 1 : 0;
      for (std::size_t other = 0; other < t; ++other) {
        const Integers m = normal(other);
        const bool same = n != none && m != none && cross(n, m) == none &&
                          dot(n, triangles[other][0] - triangles[t][0]) == 0;
        coplanar += same ? 1 : 0;
        wrong += same != (planes[t] == planes[other]) ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0u) << "reach " << reach;
    if (reach < 40) {
      EXPECT_GT(coplanar, 200u) << "reach " << reach;
      EXPECT_GT(without, 5u) << "reach " << reach;
    }
  }
}

TEST(Coplanar, NumbersHaveNoGaps) {
  const Geometry& geometry = tests::builtin("nave").geometry;
  const auto planes = planes_of(geometry);
  ASSERT_EQ(planes.size(), geometry.triangles.size());
  std::uint32_t next = 0;
  for (const std::uint32_t plane : planes) {
    ASSERT_LE(plane, next);
    if (plane == next) ++next;
  }
  EXPECT_LT(next, planes.size());
}

}  // namespace
}  // namespace airlight::scene
