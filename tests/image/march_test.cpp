#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/kinds_of_light.h"
#include "support/render.h"
#include "support/scenes.h"
#include "unit/reference/fixtures.h"

/// Airlight by look-ups of the shadow map along view rays, against the reference.
namespace airlight {
namespace {

using media::MarchJitter;
using media::MarchLookUp;
using media::MarchOptions;
using media::MarchSpacing;

constexpr MarchSpacing k_spacings[] = {MarchSpacing::distance, MarchSpacing::angle};

const char* name_of(MarchSpacing spacing) {
  return spacing == MarchSpacing::distance ? "distance" : "angle";
}

/// What 512 steps and 2048² texels leave at most.
struct Curve {
  const char* scene;
  double rrmse;
};
void PrintTo(const Curve& curve, std::ostream* stream) {
  *stream << curve.scene;
}

class MarchIn : public testing::TestWithParam<Curve> {};

TEST_P(MarchIn, ComesToTheReferenceAsStepsGrow) {
  const scene::Scene& scene = tests::builtin(GetParam().scene);
  const scene::View view = tests::view_of(scene, {48, 48});
  const tests::Truth truth = tests::trace(scene.geometry, view);
  for (const MarchSpacing spacing : k_spacings) {
    double before = 1e30, error = 0.0;
    for (const int steps : {8, 32, 128, 512}) {
      const frame::FrameImages image =
          tests::render_march(scene.geometry, view, {.steps = steps, .spacing = spacing}, 2048);
      error = tests::error_of(image, truth).rrmse;
      RecordProperty(name_of(spacing) + std::to_string(steps), std::to_string(error));
      // A change of visibility is misplaced by up to half a step.
      EXPECT_LT(error, 0.6 * before) << name_of(spacing) << " " << steps;
      before = error;
    }
    EXPECT_LT(error, GetParam().rrmse) << name_of(spacing);
  }
}

TEST_P(MarchIn, GatheredLookUpsAreBetterThanTheirNumber) {
  const scene::Scene& scene = tests::builtin(GetParam().scene);
  const scene::View view = tests::view_of(scene, {128, 128});
  const tests::Truth truth = tests::trace(scene.geometry, view);
  const auto error_by = [&](MarchJitter jitter) {
    return tests::error_of(tests::render_march(scene.geometry, view, {.steps = 8, .jitter = jitter}), truth);
  };
  const auto off = error_by(MarchJitter::off), interleaved = error_by(MarchJitter::interleaved);
  // Pixels that differ in their offset err in all directions where those in the middle of steps err alike.
  EXPECT_LT(std::abs(interleaved.bias), std::abs(off.bias) + 1e-3);
  EXPECT_LT(interleaved.rrmse, 1.5 * off.rrmse);
  const auto gathered = error_by(MarchJitter::gathered);
  RecordProperty("off", std::to_string(off.rrmse));
  RecordProperty("interleaved", std::to_string(interleaved.rrmse));
  RecordProperty("gathered", std::to_string(gathered.rrmse));
  EXPECT_LT(gathered.rrmse, 0.8 * interleaved.rrmse);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MarchIn, testing::Values(Curve{"window", 0.02}, Curve{"fence", 0.02}),
                         [](const auto& test) { return std::string(test.param.scene); });

TEST(March, LightsEmptyFogAsTheReference) {
  scene::View view = tests::view_of_coloured_fog({24, 24});
  for (const auto& [phase, g] :
       {std::pair(scene::PhaseFunction::isotropic, 0.0f), std::pair(scene::PhaseFunction::rayleigh, 0.0f),
        std::pair(scene::PhaseFunction::henyey_greenstein, 0.6f),
        std::pair(scene::PhaseFunction::henyey_greenstein, -0.97f),
        std::pair(scene::PhaseFunction::hoffman_preetham, 0.7f)}) {
    view.medium.phase = phase;
    view.medium.g = g;
    const auto truth = reference::Reference({}, view).exact().radiance;
    for (const MarchSpacing spacing : k_spacings) {
      for (const int steps : {8, 33, 200}) {
        const auto image = tests::render_march({}, view, {.steps = steps, .spacing = spacing}).airlight;
        const auto error = tests::error_of(image, truth);
        // Narrow steps count with their middle.
        EXPECT_LT(error.rrmse, 0.012) << name_of(spacing) << " " << steps << " g " << g;
        EXPECT_LT(std::abs(error.bias), 0.004) << name_of(spacing) << " " << steps << " g " << g;
      }
    }
  }
}

class MarchBy : public testing::TestWithParam<tests::KindOfLight> {};
INSTANTIATE_TEST_SUITE_P(Kinds, MarchBy, testing::ValuesIn(tests::k_kinds_of_light),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(MarchBy, IsTheReferenceAmongSlats) {
  static const scene::Geometry slats = reference::tests::clutter(40);
  const scene::View view = tests::clutter_view(GetParam(), 40);
  const tests::Truth truth = tests::trace(slats, view);
  for (const MarchLookUp look_up : {MarchLookUp::map, MarchLookUp::rows}) {
    const bool is_rows = look_up == MarchLookUp::rows;
    for (const MarchSpacing spacing : k_spacings) {
      const std::string name = name_of(spacing) + std::string(is_rows ? "_rows" : "");
      const auto error = tests::error_of(
          tests::render_march(slats, view, {.steps = 256, .look_up = look_up, .spacing = spacing}, 2048),
          truth);
      RecordProperty(name, std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias));
      // Changes of visibility lie within a step and a texel, of rows within a light ray and half a half-plane
      // as well.
      EXPECT_LT(error.rrmse, is_rows ? 0.016 : 0.012) << name;
      EXPECT_LT(std::abs(error.bias), 2e-3) << name;
    }
  }
}

TEST(March, AsksRowsWhereTheyAreKnown) {
  // Walls seen at grazing angles hide most of a row, and the half-plane's own ray goes on behind them.
  for (const char* name : {"window", "fence"}) {
    const scene::Scene& scene = tests::builtin(name);
    const scene::View view = tests::view_of(scene, {96, 96});
    const tests::Truth truth = tests::trace(scene.geometry, view);
    const auto error_by = [&](MarchLookUp look_up) {
      const auto image = tests::render_march(scene.geometry, view, {.steps = 128, .look_up = look_up}, 2048);
      return tests::error_of(image, truth).rrmse;
    };
    const double map = error_by(MarchLookUp::map), rows = error_by(MarchLookUp::rows);
    RecordProperty(name, std::to_string(map) + ", rows " + std::to_string(rows));
    EXPECT_LT(rows, 1.15 * map) << name;  // a light ray and half a half-plane beside
  }
}

/// What rows differ in from a tree over the same light rays.
auto rows_beside_tree(const scene::Geometry& geometry, const scene::View& view) {
  // So few half-planes that a row's own ray often goes on behind what the view ray ends at.
  const epipolar::Resolution coarse = {.theta = 24, .phi = 128};
  const auto tree = tests::render_vsv(
      geometry, view,
      {.resolution = coarse, .phi_cells = media::PhiCells::equal, .query = epipolar::Query::tree});
  const auto rows =
      tests::render_march(geometry, view,
                          {.steps = 512,
                           .look_up = MarchLookUp::rows,
                           .volume = {.resolution = coarse, .query = epipolar::Query::light_rays},
                           .spacing = MarchSpacing::angle});
  return tests::error_of(rows.airlight, tree.airlight);
}

TEST_P(MarchBy, RowsAreWhatATreeOverThemTells) {
  static const scene::Geometry slats = reference::tests::clutter(40);
  const auto error = rows_beside_tree(slats, tests::clutter_view(GetParam(), 40));
  RecordProperty("rrmse", std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias));
  EXPECT_LT(error.rrmse, 0.012);  // changes lie half a step beside, which counts most in heavy fog
}

TEST(March, RowsAreWhatATreeOverThemTellsBeforeWalls) {
  const scene::Scene& window = tests::builtin("window");
  const auto error = rows_beside_tree(window.geometry, tests::view_of(window, {96, 96}));
  RecordProperty("rrmse", std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias));
  EXPECT_LT(error.rrmse, 0.012);  // as above; twice as much where leaks circle the epipole
}

TEST_P(MarchBy, TakesAnyStepsAndJitter) {
  static const scene::Geometry slats = reference::tests::clutter(40);
  const scene::View view = tests::clutter_view(GetParam(), 40);
  const tests::Truth truth = tests::trace(slats, view);
  for (const MarchJitter jitter : {MarchJitter::off, MarchJitter::interleaved, MarchJitter::gathered}) {
    const auto error = tests::error_of(
        tests::render_march(slats, view, {.steps = 16, .spacing = MarchSpacing::angle, .jitter = jitter}),
        truth);
    // A rough picture of the same. What is gathered is blurred, where a lobe, an edge of a cone, or a layer
    // changes within four pixels, too.
    const bool is_gathered = jitter == MarchJitter::gathered;
    EXPECT_LT(error.rrmse, is_gathered ? 4.0 : 0.15);
    EXPECT_LT(std::abs(error.bias), is_gathered ? 0.15 : 0.02);
    RecordProperty("jitter" + std::to_string(static_cast<int>(jitter)),
                   std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias));
  }
}

double mean(const std::vector<glm::vec3>& image) {
  double sum = 0.0;
  for (const glm::vec3& value : image) sum += static_cast<double>(value.x + value.y + value.z);
  return sum / static_cast<double>(image.size());
}

TEST(March, FindsARoomWithoutLightDark) {
  scene::Geometry room;
  tests::add_box(room, {-1, -1, -1}, {1, 1, 1});
  scene::View view = tests::view_in_a_room();
  for (const scene::Light& light : {scene::point_light("", {0.5, 1.7, -2.5}, glm::vec3(100.0f)),
                                    scene::point_light("", {30, 50, 20}, glm::vec3(1e9f)),
                                    scene::sun("", {0.3, 1, -0.2}, glm::vec3(10.0f))}) {
    view.lights[0] = light;
    for (const MarchSpacing spacing : k_spacings) {
      for (const MarchJitter jitter : {MarchJitter::off, MarchJitter::interleaved, MarchJitter::gathered}) {
        const MarchOptions options{.spacing = spacing, .jitter = jitter};
        // A point nearer to a wall than the shadow map's texels tell may be lit.
        EXPECT_LT(mean(tests::render_march(room, view, options).airlight),
                  1e-4 * mean(tests::render_march({}, view, options).airlight));
      }
    }
  }
}

TEST(March, RefusesLobesThatStepsCannotFollow) {
  scene::View view = tests::clutter_view(tests::k_kinds_of_light[0], 40);
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = -0.996f;
  ASSERT_TRUE(MarchOptions{}.refusal(view));
  EXPECT_NE(MarchOptions{}.refusal(view)->problem.find("g = -0.996"), std::string::npos);
  view.medium.g = -0.995f;
  EXPECT_FALSE(MarchOptions{}.refusal(view));
}

}  // namespace
}  // namespace airlight
