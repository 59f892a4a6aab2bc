#include "scene/components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/import.h"
#include "support/scenes.h"
#include "support/shared.h"

namespace airlight::scene {
namespace {

Components components_of(const Geometry& geometry) {
  return find_components(geometry, find_edges(geometry));
}

using tests::add_box;

TEST(Components, BoxesApartAreWatertight) {
  Geometry geometry;
  add_box(geometry, {0, 0, 0}, {1, 1, 1});
  add_box(geometry, {2, 0, 0}, {3, 1, 1});
  const Components components = components_of(geometry);
  EXPECT_EQ(components.count, 2u);
  EXPECT_TRUE(components.is_watertight());
  ASSERT_EQ(components.of_triangle.size(), 24u);
  for (std::size_t t = 0; t < 24; ++t) EXPECT_EQ(components.of_triangle[t], t / 12);
}

TEST(Components, HaveTwoSidesWhereEdgesAreGoneAlongBothWays) {
  Geometry geometry;
  for (const float x : {0.0f, 2.0f, 4.0f, 6.0f}) add_box(geometry, {x, 0, 0}, {x + 1, 1, 1});
  std::swap(geometry.triangles[14].x, geometry.triangles[14].y);  // of the second, one turned round
  for (std::size_t t = 24; t < 36; ++t)                           // of the third, all
    std::swap(geometry.triangles[t].x, geometry.triangles[t].y);
  geometry.triangles.pop_back();                                   // of the fourth, one missing
  tests::add_triangle(geometry, {9, 0, 0}, {9, 0, 0}, {9, 1, 0});  // a degenerate one, for itself
  const Components components = components_of(geometry);
  EXPECT_THAT(components.has_two_sides, testing::ElementsAre(true, false, true, false, true));
  const std::vector<Box> boxes = boxes_of(components, geometry);
  EXPECT_EQ(boxes.at(2).lower, glm::vec3(4, 0, 0));
  EXPECT_EQ(boxes.at(2).upper, glm::vec3(5, 1, 1));
}

TEST(Components, MissingTriangleLeavesThreeOpenEdges) {
  Geometry geometry;
  add_box(geometry, {0, 0, 0}, {1, 1, 1});
  add_box(geometry, {2, 0, 0}, {3, 1, 1});
  geometry.triangles.pop_back();
  const Components components = components_of(geometry);
  EXPECT_FALSE(components.is_watertight());
  EXPECT_EQ(components.open_edges, 3u);
  EXPECT_EQ(components.open_components, 1u);
  EXPECT_THAT(describe_gaps(components), testing::StartsWith("1 of 2 connected parts are open: 3 edges"));
}

TEST(Components, FinOnABoxIsAnOddEdge) {
  Geometry geometry;
  add_box(geometry, {0, 0, 0}, {1, 1, 1});
  tests::add_triangle(geometry, {0, 0, 0}, {1, 0, 0}, {0, -1, 0});
  const Components components = components_of(geometry);
  EXPECT_EQ(components.count, 1u);
  EXPECT_EQ(components.odd_edges, 1u);
  EXPECT_EQ(components.open_edges, 2u);
}

TEST(Components, BoxThereTwiceCancels) {
  Geometry geometry;
  add_box(geometry, {0, 0, 0}, {1, 1, 1});
  add_box(geometry, {0, 0, 0}, {1, 1, 1});
  const Components components = components_of(geometry);
  EXPECT_EQ(components.duplicate_triangles, 12u);
  EXPECT_EQ(components.open_edges + components.odd_edges, 0u);
  EXPECT_FALSE(components.is_watertight());
}

TEST(Components, NoTrianglesAreNoComponents) {
  EXPECT_EQ(components_of({}).count, 0u);
  EXPECT_TRUE(components_of({}).is_watertight());
}

struct Model {
  const char* name;
  std::size_t parts, open_parts, open_edges, odd_edges, duplicates;
};

void PrintTo(const Model& model, std::ostream* stream) {
  *stream << model.name;
}

class ComponentsOf : public testing::TestWithParam<Model> {};

TEST_P(ComponentsOf, SharedModelsAreCounted) {
  const Model& model = GetParam();
  const auto file = tests::shared_file(std::string("scenes/") + model.name + ".glb");
  AIRLIGHT_NEEDS(file);
  const Components components = components_of(import_scene(file).geometry);
  EXPECT_EQ(components.count, model.parts);
  EXPECT_EQ(components.open_components, model.open_parts);
  EXPECT_EQ(components.open_edges, model.open_edges);
  EXPECT_EQ(components.odd_edges, model.odd_edges);
  EXPECT_EQ(components.duplicate_triangles, model.duplicates);
}

INSTANTIATE_TEST_SUITE_P(Models, ComponentsOf,
                         testing::Values(Model{"bunny_closed_144k", 2, 0, 0, 0, 0},
                                         Model{"lucy_100k", 1, 0, 0, 0, 0},
                                         Model{"bunny_holes_69k", 1, 1, 223, 0, 0},
                                         Model{"willow_garage_backtoback_14k", 24, 5, 4, 93, 6729},
                                         Model{"sponza_262k", 1489, 1438, 24999, 4, 66}));

}  // namespace
}  // namespace airlight::scene
