#include "scene/edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace airlight::scene
