#include "surface_shadows/metric_tree.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/frame_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shadow_cases.h"
#include "surface_shadows/psv.h"

/// Metric trees of clusters answer what asking every triangle does, bit for bit, whatever leaves clusters
/// out.
namespace airlight::surface_shadows {
namespace {

using tests::by_brute;
using tests::count_lit;
using tests::shadow_cases;
using tests::ShadowCase;
using tests::view_of_soup;
using tests::visibility;

std::vector<float> by_tree(const scene::Geometry& geometry, const scene::View& view,
                           const MetricTreeOptions& options) {
  MetricTree tree(options);
  return visibility(geometry, view, tree);
}

struct Setting {
  std::string name;
  MetricTreeOptions options;
};

/// The usual ones, and each means taken away.
std::vector<Setting> settings() {
  return {{"usual", {}},
          {"one triangle", {.cluster = 1}},
          {"three triangles", {.cluster = 3}},
          {"hundred triangles", {.cluster = 100}},
          {"spheres", {.capsules = Use::off}},
          {"no slabs", {.slabs = Use::off}},
          {"no distances", {.distance_cull = Use::off}},
          {"no intervals", {.interval_cull = Use::off}},
          {"all of space", {.light_view = Use::off}},
          {"none",
           {.capsules = Use::off,
            .slabs = Use::off,
            .distance_cull = Use::off,
            .interval_cull = Use::off,
            .light_view = Use::off}},
          {"other seed", {.seed = 2}},
          {"a stack of one", {.stack = 1}},
          {"a stack of one, one triangle", {.cluster = 1, .stack = 1}},
          {"a stack of three", {.cluster = 2, .stack = 3}},
          {"medians", {.build = Build::median}},
          {"medians, one triangle", {.cluster = 1, .build = Build::median}},
          {"medians, a stack of one", {.cluster = 3, .build = Build::median, .stack = 1}}};
}

/// Keeps the methods, whose shaders take a driver long to make, for all tests of a suite.
class Trees : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (const Setting& setting : settings()) exact_.emplace_back(setting.name, setting.options);
    for (const Use normal_cones : {Use::on, Use::off})
      for (const int cluster : {1, 16})
        culled_.emplace_back(
            "culled",
            MetricTreeOptions{.cluster = cluster, .normal_cones = normal_cones, .cull = Culling::automatic});
    culled_.emplace_back("culled, medians",
                         MetricTreeOptions{.cull = Culling::automatic, .build = Build::median});
  }
  static void TearDownTestSuite() {
    exact_.clear();
    culled_.clear();
  }

  static void expect_exact(const std::string& name, const scene::Geometry& geometry,
                           const scene::View& view) {
    const std::vector<float> expected = by_brute(geometry, view);
    for (Kept& kept : exact_)
      EXPECT_TRUE(visibility(geometry, view, kept.tree) == expected) << name << ", " << kept.name;
    const std::vector<float> without_culled = by_brute(geometry, view, Culling::automatic);
    for (Kept& kept : culled_)
      EXPECT_TRUE(visibility(geometry, view, kept.tree) == without_culled) << name << ", " << kept.name;
  }

  static std::vector<float> by_usual(const scene::Geometry& geometry, const scene::View& view) {
    return visibility(geometry, view, exact_.front().tree);
  }

 private:
  struct Kept {
    Kept(std::string name_, const MetricTreeOptions& options) : name(std::move(name_)), tree(options) {}
    std::string name;
    MetricTree tree;
  };
  static inline std::deque<Kept> exact_, culled_;
};

class MetricTrees : public Trees, public testing::WithParamInterface<std::size_t> {
 protected:
  static const ShadowCase& given() { return shadow_cases()[GetParam()]; }
};

TEST_P(MetricTrees, AnswerWhatAskingEveryTriangleDoes) {
  expect_exact(given().name, given().geometry, given().view);
  Psv psv({});
  EXPECT_TRUE(by_usual(given().geometry, given().view) == visibility(given().geometry, given().view, psv));
}

TEST_P(MetricTrees, AreAlikeHoweverTrianglesAreWritten) {
  const scene::Geometry other = tests::rewritten(given().geometry);
  EXPECT_TRUE(by_usual(other, given().view) == by_brute(other, given().view)) << given().name;
}

TEST_P(MetricTrees, DoNotDependOnScale) {
  for (const float scale : {1024.0f, 1.0f / 1024.0f}) {
    const ShadowCase other = tests::scaled(given(), scale);
    EXPECT_TRUE(by_usual(other.geometry, other.view) == by_brute(other.geometry, other.view))
        << given().name << ", × " << scale;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, MetricTrees, testing::Range(std::size_t{0}, shadow_cases().size()));

scene::Light lamp(glm::dvec3 position) {
  return scene::point_light("", position, glm::vec3(1e12f));
}

/// Long thin triangles, in rows along all axes, over a floor: most clusters are capsules.
scene::Geometry pickets() {
  scene::Geometry geometry;
  tests::Random random(3);
  tests::add_quad(geometry, {-6, -2, -6}, {0, 0, 12}, {12, 0, 0});
  const auto picket = [&](glm::vec3 from, glm::vec3 along, glm::vec3 across) {
    const int pieces = 6;
    for (int i = 0; i < pieces; ++i) {
      const glm::vec3 step = along / static_cast<float>(pieces);
      tests::add_quad(geometry, from + static_cast<float>(i) * step, step, across);
    }
  };
  for (int i = 0; i < 24; ++i) {
    const glm::vec3 at(random.in_box(2.0));
    const float size = static_cast<float>(random.logarithmic(0.3, 3.0)), width = 0.02f * size;
    const int axis = i % 3;
    glm::vec3 along(0.0f), across(0.0f);
    along[axis] = size;
    across[(axis + 1) % 3] = width;
    if (i % 2 == 0) along[(axis + 2) % 3] = 0.3f * size;
    picket(at, along, across);
  }
  return geometry;
}

std::uint32_t always_asked(const scene::Geometry& geometry, const scene::View& view,
                           bool* has_capsules = {}) {
  std::uint32_t count = 0;
  tests::look_into_frame(geometry, view, 16, [&](const frame::FrameInputs& inputs) {
    MetricTree tree({});
    const gpu::Texture image(gpu::Format::r32f, view.size);
    tree.query(inputs, image);
    count = tree.always_asked();
    if (has_capsules) *has_capsules = tree.capsule_share() > 0.5;
  });
  return count;
}

class TreesOfClusters : public Trees {};

TEST_F(TreesOfClusters, OfCapsulesUnderAllKindsOfLight) {
  const scene::Geometry geometry = pickets();
  bool has_capsules = false;
  always_asked(geometry, view_of_soup(lamp({1, 4, 1})), &has_capsules);
  EXPECT_TRUE(has_capsules);
  expect_exact("above", geometry, view_of_soup(lamp({1, 4, 1})));
  expect_exact("inside", geometry, view_of_soup(lamp({0.1, -0.3, 0.2})));
  expect_exact("far", geometry, view_of_soup(lamp({300, 500, 100})));
  expect_exact("sun", geometry, view_of_soup(scene::sun("", {0.3, 1, 0.2}, glm::vec3(1.0f))));
  expect_exact("low sun", geometry, view_of_soup(scene::sun("", {1, 0.01, 0.3}, glm::vec3(1.0f))));
}

TEST_F(TreesOfClusters, OfALightInAClusterOnItsAxisAndTouchingIt) {
  // One long strip along x, its capsule about y = 0 and z = 0.05.
  scene::Geometry geometry;
  tests::add_quad(geometry, {-6, -2, -6}, {0, 0, 12}, {12, 0, 0});
  for (int i = 0; i < 8; ++i)
    tests::add_quad(geometry, {-1.0f + 0.25f * static_cast<float>(i), 0, 0}, {0.25f, 0, 0}, {0, 0.02f, 0.1f});
  tests::add_box(geometry, {0.5f, -1, 0.5f}, {1, -0.5f, 1});
  const auto look = [&](const std::string& name, glm::dvec3 position) {
    const scene::View view = view_of_soup(lamp(position));
    expect_exact(name, geometry, view);
    return always_asked(geometry, view);
  };
  // All but the last are in the floor's sphere, too.
  EXPECT_EQ(look("in it", {0.1, 0.011, 0.05}), 2u);
  EXPECT_EQ(look("on its axis, inside", {-0.7, 0.01, 0.05}), 2u);
  EXPECT_EQ(look("on its axis, beyond", {1.5, 0.01, 0.05}), 1u);
  EXPECT_EQ(look("far off on its axis", {30.0, 0.01, 0.05}), 0u);
  look("touching it", {0.0, 0.01 + 0.051, 0.05});
  look("beside it", {0.0, 0.065, 0.05});
  look("at a corner", {-1.0, 0.0, 0.0});
  look("at an edge's end, along it", {-1.001, 0.0, 0.0});
}

TEST_F(TreesOfClusters, OfClustersOnEitherSideOfTheLight) {
  // Seen at each other's antipodes.
  scene::Geometry geometry;
  tests::add_quad(geometry, {-6, -2, -6}, {0, 0, 12}, {12, 0, 0});
  for (int i = 0; i < 3; ++i) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 middle(0.0f);
      middle[i] = side;
      for (int k = 0; k < 4; ++k)
        tests::add_box(geometry, middle + 0.05f * static_cast<float>(k) - 0.02f,
                       middle + 0.05f * static_cast<float>(k) + 0.02f);
    }
  }
  expect_exact("between", geometry, view_of_soup(lamp({0, 0, 0})));
  expect_exact("nearly between", geometry, view_of_soup(lamp({1e-4, 2e-5, 0})));
}

TEST_F(TreesOfClusters, OfClustersThatAreAllAlike) {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-6, -2, -6}, {0, 0, 12}, {12, 0, 0});
  for (int i = 0; i < 200; ++i) tests::add_triangle(geometry, {0, 0, 0}, {1, 0, 0.1f}, {0.2f, 0.3f, 1});
  for (int i = 0; i < 100; ++i) tests::add_triangle(geometry, {1, 0, 0}, {2, 1e-6f, 0}, {3, 0, 0});
  expect_exact("lamp", geometry, view_of_soup(lamp({0.5, 2, 0.3})));
  expect_exact("sun", geometry, view_of_soup(scene::sun("", {0.3, 1, 0.2}, glm::vec3(1.0f))));
}

TEST_F(TreesOfClusters, OfAnEmptySceneAndOfAModelOfOneTriangle) {
  const scene::Scene& empty = tests::builtin("empty");
  EXPECT_EQ(count_lit(by_tree(empty.geometry, tests::view_of(empty, {16, 16}), {})), 0u);
  scene::Geometry one;
  tests::add_triangle(one, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  scene::View view;
  view.camera.eye = {0, 0, 3};
  view.camera.target = {0, 0, 0};
  view.lights = {scene::point_light("", {1, 1, 2}, glm::vec3(1.0f))};
  view.size = {16, 16};
  EXPECT_GT(count_lit(by_tree(one, view, {})), 10u);
  view.lights[0].position.z = -2;
  EXPECT_EQ(count_lit(by_tree(one, view, {})), 0u) << "it turns its back to the light";
}

TEST_F(TreesOfClusters, OfAClosedMeshAroundTheLight) {
  scene::Geometry geometry = tests::ball();
  const auto inner = geometry.triangles.size();
  const auto count = static_cast<std::uint32_t>(geometry.positions.size());
  for (std::uint32_t i = 0; i < count; ++i) geometry.positions.push_back(3.0f * geometry.positions[i]);
  for (std::size_t i = 0; i < inner; ++i) geometry.triangles.push_back(geometry.triangles[i] + count);
  geometry.material_of_triangle.assign(geometry.triangles.size(), 0);
  scene::View view;
  view.lights = {scene::point_light("", {0, 0, 0}, glm::vec3(1.0f))};
  view.size = {96, 96};
  view.camera.eye = {0, 0, 1.9};
  view.camera.target = {0.3, 5, 2};
  view.camera.vertical_fov_degrees = 120;
  for (const int cluster : {1, 4, 16})
    EXPECT_EQ(count_lit(by_tree(geometry, view, {.cluster = cluster})), 0u);
}

TEST(MetricTree, OfMoreClustersThanAStorageBlockHoldsIsAnErrorThatNamesTheLimit) {
  const ShadowCase& given = shadow_cases()[3];
  MetricTree usual({});
  const std::vector<float> expected = visibility(given.geometry, given.view, usual);
  gpu::Limits limits = tests::gpu_context().limits();
  const std::int64_t bytes = 64 * (std::int64_t{usual.cluster_count()} + 1);
  limits.max_storage_block_bytes = bytes;
  MetricTree just({}, limits);
  EXPECT_TRUE(visibility(given.geometry, given.view, just) == expected);
  limits.max_storage_block_bytes = bytes - 1;
  MetricTree more({}, limits);
  tests::expect_error(scene::ExitCode::driver,
                      {"the tree of the model's clusters", "GL_MAX_SHADER_STORAGE_BLOCK_SIZE",
                       "let clusters have more triangles (metric-tree:cluster=N)"},
                      [&] { visibility(given.geometry, given.view, more); });
  MetricTree larger({.cluster = 32}, limits);
  EXPECT_TRUE(visibility(given.geometry, given.view, larger) == expected) << "the remedy helps";
}

TEST(MetricTree, KeepsItsClustersForTheNextRun) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "airlight_kept_clusters";
  std::filesystem::remove_all(folder);
  const ShadowCase& given = shadow_cases()[3];
  std::vector<std::string> told;
  const auto look = [&](const MetricTreeOptions& options, const std::string& made) {
    frame::Frame frame(tests::gpu_context(), given.geometry, 16, {},
                       {folder, [&](const std::string& what, double) { told.push_back(what); }});
    frame::NoAirlight no_airlight;
    gpu::StageTimer timer(&tests::gpu_context());
    MetricTree tree(options);
    frame.render(given.view, tree, no_airlight, timer);
    EXPECT_TRUE(timer.milliseconds().contains("kept_clusters"));
    EXPECT_EQ(timer.milliseconds().contains("triangle_clusters"), made == "made");
    EXPECT_EQ(told.empty(), made != "made");
    told.clear();
    EXPECT_TRUE(frame.read().visibility.at(0) == by_brute(given.geometry, given.view));
  };
  look({}, "made");
  look({}, "kept");
  look({.seed = 3}, "kept");
  look({.cluster = 8}, "made");
  look({.capsules = Use::off}, "made");
  look({.cluster = 8}, "kept");
  std::filesystem::remove_all(folder);
}

/// Means over all pixels, and several trees, which are made by chance.
struct Cost {
  double nodes, clusters, triangles;
};

Cost cost_of(const scene::Geometry& geometry, const scene::View& view, const MetricTreeOptions& options) {
  Cost cost{};
  tests::look_into_frame(geometry, view, 16, [&](const frame::FrameInputs& inputs) {
    MetricTree tree(options);
    const gpu::Texture image(gpu::Format::r32f, view.size);
    constexpr int k_trees = 3;
    const double all = k_trees * view.size.x * view.size.y;
    for (int i = 0; i < k_trees; ++i) {
      tree.query(inputs, image);
      const std::map<std::string, double> counters = tree.counters(inputs);
      cost.nodes += counters.at("surface_nodes") / all;
      cost.clusters += counters.at("surface_clusters") / all;
      cost.triangles += counters.at("surface_triangles") / all;
    }
  });
  return cost;
}

const ShadowCase& case_named(const std::string& name) {
  return *std::find_if(shadow_cases().begin(), shadow_cases().end(),
                       [&](const ShadowCase& each) { return each.name == name; });
}

TEST(MetricTree, IsSparedWorkByEachOfItsMeans) {
  const ShadowCase& given = case_named("soup above");
  const Cost usual = cost_of(given.geometry, given.view, {.cluster = 4});
  EXPECT_GT(usual.nodes, 4.0);
  EXPECT_GT(usual.triangles, usual.clusters);
  const auto without = [&](MetricTreeOptions options) {
    options.cluster = 4;
    return cost_of(given.geometry, given.view, options);
  };
  EXPECT_GT(without({.interval_cull = Use::off}).nodes, usual.nodes);
  EXPECT_GT(without({.distance_cull = Use::off}).nodes, usual.nodes);
  EXPECT_GT(without({.slabs = Use::off}).triangles, usual.triangles);
  const scene::Geometry long_ones = pickets();
  EXPECT_LT(without({.build = Build::median}).nodes, 1.3 * usual.nodes);
  EXPECT_LT(cost_of(long_ones, given.view, {}).triangles,
            0.9 * cost_of(long_ones, given.view, {.capsules = Use::off}).triangles);
}

TEST(MetricTree, LeavesOutHalfOfWhatIsClosedByNormalCones) {
  const scene::Geometry geometry = tests::ball();
  scene::View view = view_of_soup(lamp({1, 4, 1}));
  const Cost all = cost_of(geometry, view, {.cluster = 4, .cull = Culling::automatic});
  EXPECT_LT(
      all.nodes,
      cost_of(geometry, view, {.cluster = 4, .normal_cones = Use::off, .cull = Culling::automatic}).nodes);
}

}  // namespace
}  // namespace airlight::surface_shadows
