#include "surface_shadows/psv.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "frame/point_reader.h"
#include "quality/metrics.h"
#include "quality/traced.h"
#include "support/frame_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shadow_cases.h"
#include "support/shared.h"

/// Exact surface shadows: trees answer what asking every triangle does, bit for bit.
namespace airlight::surface_shadows {
namespace {

using tests::ball;
using tests::box_and_sheet;
using tests::builtin;
using tests::by_brute;
using tests::count_lit;
using tests::shadow_cases;
using tests::ShadowCase;
using tests::view_of_soup;
using tests::visibility;

std::vector<float> by_psv(const scene::Geometry& geometry, const scene::View& view,
                          const PsvOptions& options) {
  Psv psv(options);
  return visibility(geometry, view, psv);
}

class Psvs : public testing::TestWithParam<std::size_t> {
 protected:
  const ShadowCase& given() const { return shadow_cases()[GetParam()]; }
};

TEST_P(Psvs, AnswerWhatAskingEveryTriangleDoes) {
  const std::vector<float> expected = by_brute(given().geometry, given().view);
  EXPECT_GT(count_lit(expected), expected.size() / 100) << given().name;
  EXPECT_LT(count_lit(expected), expected.size()) << given().name;
  for (int seed = 0; seed < 10; ++seed)
    EXPECT_TRUE(by_psv(given().geometry, given().view, {.seed = seed}) == expected) << given().name << seed;
  EXPECT_TRUE(by_psv(given().geometry, given().view, {.wedge = Wedge::off}) == expected) << given().name;
  EXPECT_TRUE(by_psv(given().geometry, given().view, {.order = InsertionOrder::file}) == expected);
  for (int seed = 0; seed < 4; ++seed)
    EXPECT_TRUE(by_psv(given().geometry, given().view, {.seed = seed, .traversal = Traversal::stackless}) ==
                expected)
        << given().name << ", stackless, " << seed;
  for (const int stack : {1, 3})
    EXPECT_TRUE(by_psv(given().geometry, given().view, {.stack = stack}) == expected)
        << given().name << ": a stack that overflows";
  EXPECT_TRUE(by_psv(given().geometry, given().view, {.cull = Culling::automatic}) ==
              by_brute(given().geometry, given().view, Culling::automatic))
      << given().name;
}

/// How many of the points that a frame shades a method has wrong, of those that rounding leaves decided.
std::size_t count_wrong(const scene::Geometry& geometry, const scene::View& view,
                        const std::vector<float>& seen) {
  frame::PointReader reader;
  visibility(geometry, view, reader);
  quality::SharedReference reference(geometry, view, {});
  const quality::SurfaceError error = quality::surface_error(seen, reference.verdicts(0, reader.points()));
  EXPECT_LT(error.undecided_pixels, seen.size() / 50);
  return error.wrong_pixels;
}

TEST_P(Psvs, AreRightWhereTheJudgeIsSure) {
  EXPECT_EQ(count_wrong(given().geometry, given().view, by_psv(given().geometry, given().view, {})), 0u)
      << given().name;
}

TEST_P(Psvs, AreRightHoweverTrianglesAreWritten) {
  const scene::Geometry other = tests::rewritten(given().geometry);
  EXPECT_EQ(count_wrong(other, given().view, by_psv(other, given().view, {})), 0u) << given().name;
}

TEST_P(Psvs, DoNotDependOnScale) {
  const std::vector<float> expected = by_psv(given().geometry, given().view, {});
  for (const float scale : {1024.0f, 1.0f / 1024.0f}) {
    const ShadowCase other = tests::scaled(given(), scale);
    EXPECT_TRUE(by_psv(other.geometry, other.view, {}) == expected) << given().name << ", × " << scale;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Psvs, testing::Range(std::size_t{0}, std::size_t{9}));

// What the eye sees, between the corners and edges of a closed mesh around the light, is a wall beyond. Its
// corners are those of the mesh, projected, so that rasterised points lie along the edges' planes.
TEST(Psv, LeavesNoLightThroughEdgesOfAClosedMesh) {
  scene::Geometry geometry = ball();
  const std::size_t inner = geometry.triangles.size();
  const auto count = static_cast<std::uint32_t>(geometry.positions.size());
  for (std::uint32_t i = 0; i < count; ++i) geometry.positions.push_back(3.0f * geometry.positions[i]);
  for (std::size_t i = 0; i < inner; ++i) geometry.triangles.push_back(geometry.triangles[i] + count);
  geometry.material_of_triangle.assign(geometry.triangles.size(), 0);
  scene::View view;
  view.lights = {scene::point_light("", {0, 0, 0}, glm::vec3(1.0f))};
  view.size = {96, 96};
  view.camera.eye = {0, 0, 1.9};
  view.camera.vertical_fov_degrees = 120;
  for (const glm::dvec3 target : {glm::dvec3(0, 0, 5), glm::dvec3(5, 0, 1.8), glm::dvec3(0.3, 5, 2)}) {
    view.camera.target = target;
    const std::vector<float> seen = by_psv(geometry, view, {});
    EXPECT_EQ(count_lit(seen), 0u);
  }
}

// Eye, light and the edges between the two halves of a fan lie in one plane, turned about so that no number
// of it is round: along the image's middle column each point lies in that plane to rounding.
TEST(Psv, LeavesNoLightInThePlaneOfManyEdges) {
  tests::Random random(11);
  for (int turn = 0; turn < 12; ++turn) {
    const glm::dvec3 forward = random.direction();
    const glm::dvec3 right = glm::normalize(glm::cross(forward, random.direction()));
    const glm::dvec3 up = glm::cross(right, forward);
    const auto at = [&](double x, double y, double z) { return glm::vec3(x * right + y * up + z * forward); };
    scene::Geometry geometry;
    for (int row = 0; row < 40; ++row) {
      const double y = -2 + 0.1 * row;
      for (const double side : {-1.0, 1.0}) {
        tests::add_triangle(geometry, at(0, y, 2), at(0, y + 0.1, 2), at(side * 4, y + 0.05, 2));
        tests::add_triangle(geometry, at(side * 4, y + 0.05, 2), at(0, y + 0.1, 2),
                            at(side * 4, y + 0.15, 2));
      }
    }
    const std::size_t occluders = geometry.triangles.size();
    tests::add_triangle(geometry, at(-40, -40, 6), at(40, -40, 6), at(0, 60, 6));
    scene::View view;
    view.camera.eye = glm::dvec3(at(0, 0, 2.5));
    view.camera.target = glm::dvec3(at(0, 0, 6));
    view.camera.up = up;
    view.camera.vertical_fov_degrees = 60;
    view.lights = {scene::point_light("", glm::dvec3(at(0, 0.3, 0)), glm::vec3(1e3f))};
    view.size = {9, 65};
    const std::vector<float> seen = by_psv(geometry, view, {.seed = turn});
    EXPECT_EQ(count_lit(seen), 0u) << turn << ", " << occluders << " triangles";
  }
}

TEST(Psv, OfAnEmptySceneAndOfAModelOfOneTriangle) {
  const scene::Scene& empty = builtin("empty");
  EXPECT_EQ(count_lit(by_psv(empty.geometry, tests::view_of(empty, {16, 16}), {})), 0u);
  scene::Geometry one;
  tests::add_triangle(one, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  scene::View view;
  view.camera.eye = {0, 0, 3};
  view.camera.target = {0, 0, 0};
  view.lights = {scene::point_light("", {1, 1, 2}, glm::vec3(1.0f))};
  view.size = {16, 16};
  EXPECT_GT(count_lit(by_psv(one, view, {})), 10u);
  view.lights[0].position.z = -2;
  EXPECT_EQ(count_lit(by_psv(one, view, {})), 0u) << "it turns its back to the light";
}

double nodes_a_pixel(const scene::Geometry& geometry, const scene::View& view, const PsvOptions& options) {
  double mean = 0.0;
  tests::look_into_frame(geometry, view, 16, [&](const frame::FrameInputs& inputs) {
    Psv psv(options);
    const gpu::Texture visibility(gpu::Format::r32f, view.size), counts(gpu::Format::r32f, view.size);
    psv.query(inputs, visibility);
    psv.count_nodes(inputs, counts);
    const std::vector<float> nodes = counts.read<float>();
    mean = std::accumulate(nodes.begin(), nodes.end(), 0.0) / static_cast<double>(nodes.size());
  });
  return mean;
}

TEST(Psv, VisitsFewerNodesByItsWedges) {
  // The order in which invocations insert triangles is chance, and so is a tree: here wedges spare nearly a
  // half of the nodes, and no tree in which they spare less than a third was seen.
  const ShadowCase& given = *std::find_if(shadow_cases().begin(), shadow_cases().end(),
                                          [](const ShadowCase& each) { return each.name == "soup sun"; });
  const double usual = nodes_a_pixel(given.geometry, given.view, {});
  EXPECT_GT(usual, 4.0);
  EXPECT_LT(1.5 * usual, nodes_a_pixel(given.geometry, given.view, {.wedge = Wedge::off}));
}

TEST(Culling, LeavesOutHalfOfWhatIsClosedAndNothingElse) {
  const scene::Geometry geometry = box_and_sheet();
  scene::View view = view_of_soup(scene::point_light("", {0.13, 4, 0.07}, glm::vec3(1e3f)));
  const auto expect_same = [&](const std::string& what) {
    const std::vector<float> all = by_brute(geometry, view);
    EXPECT_LT(count_lit(all), 64u * 40u) << what;
    const std::vector<float> culled = by_brute(geometry, view, Culling::automatic);
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_EQ(all[i], culled[i]) << what << ", pixel " << i % 64 << ' ' << i / 64;
    EXPECT_TRUE(by_psv(geometry, view, {.cull = Culling::automatic}) == all) << what;
  };
  expect_same("lamp above");
  EXPECT_LT(nodes_a_pixel(geometry, view, {.cull = Culling::automatic}),
            0.9 * nodes_a_pixel(geometry, view, {}));
  view.lights[0].position = {-0.7, -0.5, 0.1};
  EXPECT_TRUE(by_brute(geometry, view, Culling::automatic) == by_brute(geometry, view)) << "lamp in the box";
  view.lights = {scene::sun("", {0.3, 1, 0.2}, glm::vec3(1.0f))};
  expect_same("sun");
  view.camera.eye = {-0.7, -0.5, 0.1};
  view.camera.target = {-0.7, -1, 0};
  EXPECT_EQ(count_lit(by_brute(geometry, view, Culling::automatic)), 0u) << "eye in the box";
}

}  // namespace
}  // namespace airlight::surface_shadows
