#include "surface_shadows/triangle_clusters.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "frame/clusters.h"
#include "support/scenes.h"

namespace airlight::surface_shadows {
namespace {

std::vector<std::uint32_t> order_of(const scene::Geometry& geometry) {
  return frame::make_clusters(geometry).order;
}

/// Every triangle is in one cluster, which bounds it, and has no more than it may.
void expect_whole(const scene::Geometry& geometry, const std::vector<std::uint32_t>& order,
                  const std::vector<std::uint32_t>& parts, const TriangleClusters& made, std::uint32_t most) {
  std::vector<std::uint32_t> sorted = made.triangles;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> all(order.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(sorted, all);
  std::uint32_t next = 0;
  for (const TriangleCluster& cluster : made.clusters) {
    const std::uint32_t count = cluster.count_and_part % k_part_unit,
                        part = cluster.count_and_part / k_part_unit;
    EXPECT_EQ(cluster.first, next);
    next += count;
    EXPECT_GE(count, 1u);
    EXPECT_LE(count, most);
    for (std::uint32_t i = cluster.first; i < next; ++i) {
      EXPECT_EQ(parts.empty() ? 0u : parts[made.triangles[i]], part);
      const glm::uvec3 t = geometry.triangles[order[made.triangles[i]]];
      if (cluster.bounds.is_sphere()) {
        EXPECT_LE(glm::distance(glm::dvec3(geometry.positions[t.x]), glm::dvec3(cluster.bounds.from)),
                  static_cast<double>(cluster.bounds.radius));
      }
    }
  }
  EXPECT_EQ(next, order.size());
}

TEST(TriangleClusters, HaveEveryTriangleOnceAndNoMoreThanTheyMay) {
  const scene::Geometry& geometry = tests::builtin("toroid").geometry;
  const std::vector<std::uint32_t> order = order_of(geometry);
  std::size_t last = order.size() + 1;
  for (const std::uint32_t most : {1u, 5u, 16u, 32u, 600u}) {
    const TriangleClusters made = make_triangle_clusters(geometry, order, {}, {.most_triangles = most});
    expect_whole(geometry, order, {}, made, most);
    EXPECT_LT(made.clusters.size(), last);
    EXPECT_GE(made.clusters.size() * most, order.size());
    if (most > 1 && most < 512) {
      EXPECT_LT(made.clusters.size() * most, 4 * order.size()) << "they are not nearly empty";
    }
    last = made.clusters.size();
  }
}

TEST(TriangleClusters, AreTheSameEachTime) {
  const scene::Geometry& geometry = tests::builtin("toroid").geometry;
  const std::vector<std::uint32_t> order = order_of(geometry);
  const TriangleClusters first = make_triangle_clusters(geometry, order, {}, {});
  for (int i = 0; i < 3; ++i) {
    const TriangleClusters again = make_triangle_clusters(geometry, order, {}, {});
    EXPECT_EQ(again.triangles, first.triangles);
    ASSERT_EQ(again.clusters.size(), first.clusters.size());
    EXPECT_EQ(std::memcmp(again.clusters.data(), first.clusters.data(),
                          first.clusters.size() * sizeof(TriangleCluster)),
              0);
  }
}

TEST(TriangleClusters, TellHowFarTheyAre) {
  const scene::Geometry& geometry = tests::builtin("toroid").geometry;
  std::vector<double> told;
  make_triangle_clusters(geometry, order_of(geometry), {}, {}, {},
                         [&](double fraction) { told.push_back(fraction); });
  EXPECT_GT(told.size(), 3u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
}

TEST(TriangleClusters, SpanNoParts) {
  const scene::Geometry& geometry = tests::builtin("cornell").geometry;
  const std::vector<std::uint32_t> order = order_of(geometry);
  std::vector<std::uint32_t> parts(order.size());
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = static_cast<std::uint32_t>(i * i % 3);
  expect_whole(geometry, order, parts, make_triangle_clusters(geometry, order, parts, {}), 16);
}

TEST(TriangleClusters, SpanNoObjectsNeither) {
  const scene::Geometry& geometry = tests::builtin("toroid").geometry;
  const std::vector<std::uint32_t> order = order_of(geometry);
  std::vector<std::uint32_t> parts(order.size()), objects(order.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i] = static_cast<std::uint32_t>(i * i % 3);
    objects[i] = static_cast<std::uint32_t>(i / 7 % 2);
  }
  const TriangleClusters made = make_triangle_clusters(geometry, order, parts, {}, objects);
  expect_whole(geometry, order, parts, made, 16);
  for (const TriangleCluster& cluster : made.clusters)
    for (std::uint32_t i = 0; i < cluster.count_and_part % k_part_unit; ++i)
      ASSERT_EQ(objects[made.triangles[cluster.first + i]], objects[made.triangles[cluster.first]]);
}

TEST(TriangleClusters, OfTrianglesThatAreAllAlikeAndOfNone) {
  scene::Geometry geometry;
  EXPECT_TRUE(make_triangle_clusters(geometry, {}, {}, {}).clusters.empty());
  for (int i = 0; i < 1000; ++i) tests::add_triangle(geometry, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::vector<std::uint32_t> order = order_of(geometry);
  const TriangleClusters made = make_triangle_clusters(geometry, order, {}, {});
  expect_whole(geometry, order, {}, made, 16);
}

TEST(TriangleClusters, AreSmallerThanRunsOfTheSameLength) {
  const scene::Geometry& geometry = tests::builtin("toroid").geometry;
  const std::vector<std::uint32_t> order = order_of(geometry);
  const TriangleClusters made = make_triangle_clusters(geometry, order, {}, {});
  const auto area = [](const ClusterBounds& bounds) {
    return static_cast<double>(bounds.radius * bounds.radius);
  };
  const std::size_t length = order.size() / made.clusters.size();
  double of_clusters = 0.0, of_runs = 0.0;
  for (const TriangleCluster& cluster : made.clusters) of_clusters += area(cluster.bounds);
  for (std::size_t first = 0; first < order.size(); first += length) {
    std::vector<glm::uvec3> run;
    for (std::size_t i = first; i < std::min(first + length, order.size()); ++i)
      run.push_back(geometry.triangles[order[i]]);
    of_runs += area(bounds_of(geometry, run));
  }
  EXPECT_LT(of_clusters, 0.8 * of_runs);
}

}  // namespace
}  // namespace airlight::surface_shadows
