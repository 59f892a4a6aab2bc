#include "scene/edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/import.h"
#include "support/shared.h"

namespace airlight::scene {
namespace {

using testing::ElementsAre;

TEST(Edges, OfTwoTrianglesThatShareOneAreFive) {
  Geometry geometry;
  geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  geometry.triangles = {{0, 1, 2}, {2, 1, 3}};
  const Edges edges = find_edges(geometry);
  ASSERT_EQ(edges.edges.size(), 5u);
  int shared = 0;
  for (const Edges::Edge& edge : edges.edges) {
    EXPECT_LT(edge.lower, edge.upper);
    if (edge.count == 1) continue;
    ++shared;
    EXPECT_THAT(edges.triangles_of(edge), ElementsAre(0u, 1u));
    EXPECT_EQ(edge.lower, std::min(edges.position_of_vertex[1], edges.position_of_vertex[2]));
    EXPECT_EQ(edge.upper, std::max(edges.position_of_vertex[1], edges.position_of_vertex[2]));
  }
  EXPECT_EQ(shared, 1);
}

TEST(Edges, MeetWherePositionsDoThoughVerticesDiffer) {
  Geometry geometry;
  geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 1, 0}, {1, 0, 0}, {1, 1, 0}, {5, 5, 5}};
  geometry.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Edges edges = find_edges(geometry);
  EXPECT_EQ(edges.position_of_vertex[2], edges.position_of_vertex[3]) << "−0 and 0 are one place";
  EXPECT_EQ(edges.edges.size(), 5u);
}

TEST(Edges, KeepEveryTriangleOfAFan) {
  Geometry geometry;
  geometry.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  geometry.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const Edges edges = find_edges(geometry);
  EXPECT_EQ(edges.edges.size(), 7u);
  const auto axis = std::find_if(edges.edges.begin(), edges.edges.end(),
                                 [](const Edges::Edge& edge) { return edge.count == 3; });
  ASSERT_NE(axis, edges.edges.end());
  EXPECT_THAT(edges.triangles_of(*axis), ElementsAre(0u, 1u, 2u));
  EXPECT_TRUE(find_edges({}).edges.empty());
}

TEST(Edges, OfASoupAreThoseOfASearch) {
  // Corners of a small lattice, so that positions, edges and whole triangles come again.
  std::mt19937 random(7);
  Geometry geometry;
  for (int i = 0; i < 3000; ++i)
    geometry.positions.emplace_back(random() % 6, random() % 6, static_cast<float>(random() % 2) - 1.0f);
  for (int i = 0; i < 4000; ++i)
    geometry.triangles.emplace_back(random() % 3000, random() % 3000, random() % 3000);
  const auto place = [&](std::uint32_t vertex) {
    const glm::vec3 p = geometry.positions[vertex] + 0.0f;
    return std::array{p.x, p.y, p.z};
  };
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, std::vector<std::uint32_t>> expected;
  std::set<std::pair<std::uint32_t, std::uint32_t>> by_vertex;
  for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = geometry.triangles[t][i], b = geometry.triangles[t][(i + 1) % 3];
      expected[std::minmax({place(a), place(b)})].push_back(t);
      by_vertex.insert(std::minmax(a, b));
    }
  }
  const Edges edges = find_edges(geometry);
  ASSERT_EQ(edges.edges.size(), expected.size());
  std::vector<std::uint32_t> vertex_at(edges.position_of_vertex.size());
  for (std::uint32_t v = 0; v < geometry.positions.size(); ++v) vertex_at[edges.position_of_vertex[v]] = v;
  for (const Edges::Edge& edge : edges.edges) {
    const auto ends = std::minmax({place(vertex_at[edge.lower]), place(vertex_at[edge.upper])});
    EXPECT_THAT(edges.triangles_of(edge), testing::ElementsAreArray(expected.at(ends)));
  }
  EXPECT_TRUE(std::is_sorted(edges.edges.begin(), edges.edges.end(), [](const auto& a, const auto& b) {
    return std::pair(a.lower, a.upper) < std::pair(b.lower, b.upper);
  }));

  const EdgeCounts counts = count_edges(geometry);
  EXPECT_EQ(counts.by_vertex, by_vertex.size());
  EXPECT_EQ(counts.by_position, expected.size());
  std::size_t open = 0, many = 0, most = 0;
  for (const auto& [ends, triangles] : expected) {
    open += triangles.size() == 1;
    many += triangles.size() > 2;
    most = std::max(most, triangles.size());
  }
  EXPECT_EQ(counts.open, open);
  EXPECT_EQ(counts.of_more_than_two, many);
  EXPECT_EQ(counts.most_triangles, most);
}

TEST(Edges, OfSponzaAreThoseOfItsFile) {
  const std::filesystem::path file = tests::shared_file("scenes/sponza_262k.glb");
  AIRLIGHT_NEEDS(file);
  const EdgeCounts counts = count_edges(import_scene(file).geometry);
  EXPECT_EQ(counts.by_vertex, 440520u);
  EXPECT_EQ(counts.by_position, 405824u);
  EXPECT_EQ(counts.open, 24999u);
  EXPECT_EQ(counts.of_more_than_two, 78u);
  EXPECT_LE(counts.most_triangles, 4u);
}

}  // namespace
}  // namespace airlight::scene
