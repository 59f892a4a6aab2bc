#include "frame/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"

namespace airlight::frame {
namespace {

using tests::Random;

/// `count` triangles of many sizes, within `half_side` of the origin.
scene::Geometry random_triangles(Random& random, int count, double half_side) {
  scene::Geometry geometry;
  geometry.materials.emplace_back();
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 centre = random.in_box(half_side);
    const double size = half_side * random.logarithmic(1e-3, 1.0);
    const auto first = static_cast<std::uint32_t>(geometry.positions.size());
    for (int corner = 0; corner < 3; ++corner)
      geometry.positions.emplace_back(centre + size * random.direction());
    geometry.triangles.emplace_back(first, first + 1, first + 2);
    geometry.material_of_triangle.push_back(0);
  }
  return geometry;
}

/// A point of a triangle, from two numbers in [0, 1).
glm::dvec3 point_of(const scene::Geometry& geometry, std::uint32_t triangle, double u, double v) {
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const glm::uvec3 t = geometry.triangles[triangle];
  const glm::dvec3 a(geometry.positions[t.x]), b(geometry.positions[t.y]), c(geometry.positions[t.z]);
  return a + u * (b - a) + v * (c - a);
}

TEST(Clusters, OrderIsAPermutationCutIntoRuns) {
  Random random(1);
  for (int count : {0, 1, 127, 128, 129, 1000}) {
    const scene::Geometry geometry = random_triangles(random, count, 10);
    const Clusters result = make_clusters(geometry);
    std::vector<std::uint32_t> sorted = result.order;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), static_cast<std::size_t>(count));
    for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
    std::uint32_t next = 0;
    for (const Cluster& cluster : result.clusters) {
      EXPECT_EQ(cluster.first_triangle, next);
      EXPECT_GE(cluster.triangle_count, 1u);
      EXPECT_LE(cluster.triangle_count, k_cluster_triangles);
      next += cluster.triangle_count;
    }
    EXPECT_EQ(next, static_cast<std::uint32_t>(count));
  }
}

TEST(Clusters, BoxesHoldTheirTriangles) {
  Random random(2);
  const scene::Geometry geometry = random_triangles(random, 2000, 10);
  const Clusters result = make_clusters(geometry);
  for (const Cluster& cluster : result.clusters) {
    for (std::uint32_t i = 0; i < cluster.triangle_count; ++i) {
      const glm::uvec3 triangle = geometry.triangles[result.order[cluster.first_triangle + i]];
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3 p = geometry.positions[triangle[corner]];
        EXPECT_TRUE(glm::all(glm::lessThanEqual(cluster.box.lower, p)) &&
                    glm::all(glm::lessThanEqual(p, cluster.box.upper)));
      }
    }
  }
}

TEST(Clusters, NeighboursInTheOrderAreNeighboursInSpace) {
  Random random(3);
  scene::Geometry geometry = random_triangles(random, 8192, 10);
  for (std::size_t i = 0; i < geometry.positions.size();
       i += 3) {  // tiny ones, so that boxes show their places
    geometry.positions[i + 1] = geometry.positions[i] + glm::vec3(1e-3f, 0, 0);
    geometry.positions[i + 2] = geometry.positions[i] + glm::vec3(0, 1e-3f, 0);
  }
  double volume = 0.0;
  for (const Cluster& cluster : make_clusters(geometry).clusters) {
    const glm::dvec3 size(cluster.box.upper - cluster.box.lower);
    volume += size.x * size.y * size.z;
  }
  EXPECT_LT(volume, 3 * std::pow(40.0, 3))
      << "in any order, each of 64 boxes would be almost as large as the whole";
}

TEST(Clusters, ManyTrianglesInOnePlaceAndFlatScenesWork) {
  Random random(4);
  scene::Geometry geometry = random_triangles(random, 300, 1);
  for (glm::vec3& position : geometry.positions) position.y = 3.0f;
  EXPECT_EQ(make_clusters(geometry).order.size(), 300u);
  for (std::size_t i = 0; i < geometry.positions.size(); ++i)
    geometry.positions[i] = geometry.positions[i % 3];
  EXPECT_EQ(make_clusters(geometry).order.size(), 300u);
}

Pyramid random_pyramid(Random& random) {
  const glm::dvec3 forward = random.direction();
  const glm::dvec3 right = glm::normalize(glm::cross(forward, random.direction()));
  return {.apex = random.in_box(12),
          .right = right,
          .up = glm::cross(right, forward),
          .forward = forward,
          .half_width = random.logarithmic(0.01, 3),
          .half_height = random.logarithmic(0.01, 3)};
}

bool contains(const Pyramid& pyramid, glm::dvec3 point) {
  const glm::dvec3 p = point - pyramid.apex;
  const double depth = glm::dot(p, pyramid.forward);
  return depth >= 0 && std::abs(glm::dot(p, pyramid.right)) <= pyramid.half_width * depth &&
         std::abs(glm::dot(p, pyramid.up)) <= pyramid.half_height * depth;
}

TEST(MayTouch, NeverSaysNoToATriangleThatIsPartlyInside) {
  Random random(5);
  int inside = 0, refused = 0;
  for (int round = 0; round < 300; ++round) {
    const scene::Geometry geometry = random_triangles(random, 40, 10);
    const Pyramid pyramid = random_pyramid(random);
    for (std::uint32_t triangle = 0; triangle < 40; ++triangle) {
      scene::Box box;
      for (int corner = 0; corner < 3; ++corner)
        box.include(geometry.positions[geometry.triangles[triangle][corner]]);
      const bool may = may_touch(pyramid, box);
      refused += may ? 0 : 1;
      for (int sample = 0; sample < 50; ++sample) {
        if (!contains(pyramid, point_of(geometry, triangle, random.uniform(), random.uniform()))) continue;
        EXPECT_TRUE(may);
        ++inside;
        break;
      }
    }
  }
  EXPECT_GT(inside, 400) << "the test must see triangles inside";
  EXPECT_GT(refused, 5000) << "and boxes that are left out";
}

TEST(MayTouch, AnswersTheEasyCases) {
  const Pyramid pyramid{.apex = {0, 0, 0},
                        .right = {1, 0, 0},
                        .up = {0, 1, 0},
                        .forward = {0, 0, -1},
                        .half_width = 1,
                        .half_height = 1};
  EXPECT_TRUE(may_touch(pyramid, {{-1, -1, -5}, {1, 1, -4}}));
  EXPECT_TRUE(may_touch(pyramid, {{-1, -1, -1}, {1, 1, 1}})) << "around the apex";
  EXPECT_TRUE(may_touch(pyramid, {{4.9f, 0, -5}, {6, 1, -4}}));
  EXPECT_FALSE(may_touch(pyramid, {{-1, -1, 4}, {1, 1, 5}})) << "behind";
  EXPECT_FALSE(may_touch(pyramid, {{8, 0, -5}, {9, 1, -4}})) << "aside";
  EXPECT_FALSE(may_touch(pyramid, {{0, 8, -5}, {1, 9, -4}})) << "above";
}

TEST(DistanceToGeometry, EqualsThatToTheNearestOfAllPoints) {
  Random random(6);
  const scene::Geometry geometry = random_triangles(random, 400, 10);
  const Clusters clusters = make_clusters(geometry);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 point = random.in_box(15);
    const double distance = distance_to_geometry(geometry, clusters, point);
    // Walk down to the nearest point of each triangle on ever finer lattices of it.
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t triangle = 0; triangle < 400; ++triangle) {
      double u = 0.5, v = 0.25, reach = 0.5, best = std::numeric_limits<double>::infinity();
      for (int level = 0; level < 22; ++level, reach *= 0.6) {
        double best_u = u, best_v = v;
        for (int a = -2; a <= 2; ++a) {
          for (int b = -2; b <= 2; ++b) {
            const double x = std::clamp(u + a * 0.5 * reach, 0.0, 1.0),
                         y = std::clamp(v + b * 0.5 * reach, 0.0, 1.0 - x);
            const double d = glm::length(point_of(geometry, triangle, x, y) - point);
            if (d < best) best = d, best_u = x, best_v = y;
          }
        }
        u = best_u, v = best_v;
      }
      nearest = std::min(nearest, best);
    }
    EXPECT_LE(distance, nearest + 1e-9) << "a lower bound";
    EXPECT_NEAR(distance, nearest, 1e-3) << "as exact as the lattice";
  }
}

TEST(DistanceToGeometry, IsZeroOnASurfaceAndInfiniteWithoutOne) {
  Random random(7);
  const scene::Geometry geometry = random_triangles(random, 300, 10);
  const Clusters clusters = make_clusters(geometry);
  for (std::uint32_t triangle = 0; triangle < 300; ++triangle) {
    EXPECT_LT(distance_to_geometry(geometry, clusters,
                                   point_of(geometry, triangle, random.uniform(), random.uniform())),
              1e-9);
  }
  EXPECT_EQ(distance_to_geometry({}, make_clusters({}), {1, 2, 3}), std::numeric_limits<double>::infinity());
}

TEST(TrianglesWithin, AreThoseNoFartherThanTheReach) {
  Random random(8);
  const scene::Geometry geometry = random_triangles(random, 400, 10);
  const Clusters clusters = make_clusters(geometry);
  for (std::uint32_t place = 0; place < 400; ++place) {
    const std::uint32_t triangle = clusters.order[place];
    const glm::dvec3 point = point_of(geometry, triangle, 0.3, 0.4);
    EXPECT_THAT(triangles_within(geometry, clusters, point, 1e-9), testing::Contains(place));
    scene::Geometry alone;
    alone.positions = geometry.positions;
    alone.triangles = {geometry.triangles[triangle]};
    const double distance = distance_to_geometry(alone, make_clusters(alone), {1, 2, 3});
    EXPECT_THAT(triangles_within(geometry, clusters, {1, 2, 3}, distance * (1 + 1e-12)),
                testing::Contains(place));
    EXPECT_THAT(triangles_within(geometry, clusters, {1, 2, 3}, distance * (1 - 1e-12)),
                testing::Not(testing::Contains(place)));
  }
}

TEST(TrianglesWithin, OneWithoutAnAreaIsAsFarAsItsEdges) {
  scene::Geometry needle;
  needle.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  needle.triangles = {{0, 1, 2}};
  const Clusters clusters = make_clusters(needle);
  EXPECT_EQ(triangles_within(needle, clusters, {1.5, 0, 0}, 0.0).size(), 1u);
  EXPECT_EQ(triangles_within(needle, clusters, {1.5, 1, 0}, 0.5).size(), 0u);
  EXPECT_EQ(distance_to_geometry(needle, clusters, {1.5, 1, 0}), 1.0);
}

}  // namespace
}  // namespace airlight::frame
