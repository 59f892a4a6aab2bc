#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/kinds_of_light.h"
#include "support/render.h"
#include "support/scenes.h"

/// Airlight from a volume of the view frustum, against the reference.
namespace airlight {
namespace {

using media::FroxelOptions;

class FroxelIn : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, FroxelIn, testing::Values("window", "fence", "half-space"));

TEST_P(FroxelIn, ComesToTheReferenceAsFroxelsShrink) {
  const scene::Scene& scene = tests::builtin(GetParam());
  const scene::View view = tests::view_of(scene, {64, 64});
  const tests::Truth truth = tests::trace(scene.geometry, view);
  double before = 1e30;
  for (const FroxelOptions options :
       {FroxelOptions{.tile = 8, .slices = 32}, FroxelOptions{.tile = 2, .slices = 128},
        FroxelOptions{.tile = 1, .slices = 512}}) {
    const auto error = tests::error_of(tests::render_froxel(scene.geometry, view, options, 2048), truth);
    RecordProperty(std::to_string(options.tile), std::to_string(error.rrmse));
    // Airlight is interpolated, and a froxel lit or dark as a whole.
    EXPECT_LT(error.rrmse, 0.6 * before) << options.tile;
    before = error.rrmse;
  }
  EXPECT_LT(before, 0.05);
}

TEST(Froxel, LightsEmptyFogAsTheReference) {
  scene::View view = tests::view_of_coloured_fog({50, 35});  // tiles over the image's sides
  for (const auto& [phase, g] :
       {std::pair(scene::PhaseFunction::isotropic, 0.0f), std::pair(scene::PhaseFunction::rayleigh, 0.0f),
        std::pair(scene::PhaseFunction::henyey_greenstein, 0.6f),
        std::pair(scene::PhaseFunction::hoffman_preetham, 0.7f)}) {
    view.medium.phase = phase;
    view.medium.g = g;
    const auto truth = reference::Reference({}, view).exact().radiance;
    for (const FroxelOptions options :
         {FroxelOptions{.tile = 4}, FroxelOptions{.tile = 2, .slices = 32, .samples = 4},
          FroxelOptions{.tile = 1, .slices = 512}}) {
      const auto error = tests::error_of(tests::render_froxel({}, view, options).airlight, truth);
      // Where the lamp is seen, airlight has a cusp in the middle of tiles that are interpolated.
      EXPECT_LT(error.rrmse, options.tile == 1 ? 0.006 : 0.3) << "tile " << options.tile << ", g " << g;
      EXPECT_LT(std::abs(error.bias), options.tile == 1 ? 5e-4 : 0.03)
          << "tile " << options.tile << ", g " << g;
    }
  }
}

TEST(Froxel, IsReadAtTheDepthOfSurfacesBetweenTheEndsOfSlices) {
  // A thin wall edge-on to the sun, so that all air is lit, seen aslant through slices so thick that half of
  // one shows.
  scene::Geometry wall;
  tests::add_box(wall, {-8, -5, -2.501}, {3, 5, -2.5});
  scene::View view = tests::view_of_coloured_fog({32, 24});
  view.camera.eye = {0.0, 0.0, 0.0};
  view.camera.target = {-0.8, 0.0, -1.0};
  view.lights[0] = scene::sun("", {0.0, 1.0, 0.0}, glm::vec3(2.0f));
  const tests::Truth truth = tests::trace(wall, view);
  const auto error =
      tests::error_of(tests::render_froxel(wall, view, {.tile = 1, .slices = 16}, 1024), truth);
  RecordProperty("rrmse", std::to_string(error.rrmse));
  EXPECT_LT(error.rrmse, 0.01);  // airlight is interpolated along a slice
  EXPECT_LT(std::abs(error.bias), 0.005);
}

class FroxelBy : public testing::TestWithParam<tests::KindOfLight> {};
INSTANTIATE_TEST_SUITE_P(Kinds, FroxelBy, testing::ValuesIn(tests::k_kinds_of_light),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(FroxelBy, IsTheReferenceAmongSlats) {
  static const scene::Geometry slats = reference::tests::clutter(40);
  const scene::View view = tests::clutter_view(GetParam(), 40);
  const tests::Truth truth = tests::trace(slats, view);
  const auto error =
      tests::error_of(tests::render_froxel(slats, view, {.tile = 1, .slices = 512}, 2048), truth);
  RecordProperty("rrmse", std::to_string(error.rrmse));
  RecordProperty("bias", std::to_string(error.bias));
  // A froxel is lit or dark as a whole; and beyond the last slice all is as lit as at its end, where the
  // shadows by a sun from behind go on along rays without end.
  EXPECT_LT(error.rrmse, std::string(GetParam().name) == "SunFromBehind" ? 0.08 : 0.02);
  EXPECT_LT(std::abs(error.bias), 6e-3);
}

TEST(Froxel, FindsARoomWithoutLightDark) {
  // Its walls are thicker than a froxel: what lies behind them is mixed with what lies before.
  scene::Geometry room;
  tests::add_box(room, {-1, -1, -1}, {1, 1, 1});
  tests::add_box(room, {-2, -2, -2}, {2, 2, 2});
  scene::View view = tests::view_in_a_room();
  for (const scene::Light& light : {scene::point_light("", {0.5, 2.7, -3.5}, glm::vec3(100.0f)),
                                    scene::sun("", {0.3, 1, -0.2}, glm::vec3(10.0f))}) {
    view.lights[0] = light;
    for (const FroxelOptions options : {FroxelOptions{}, FroxelOptions{.tile = 2, .samples = 4}})
      for (const glm::vec3& radiance : tests::render_froxel(room, view, options).airlight)
        ASSERT_EQ(radiance, glm::vec3(0.0f));
  }
}

TEST(Froxel, CountsItsMemory) {
  const scene::Scene& scene = tests::builtin("cornell");
  const scene::View view = tests::view_of(scene, {50, 34});
  media::Froxel froxel({.tile = 8, .slices = 20});
  tests::render_airlight(scene.geometry, view, froxel, 64);
  EXPECT_EQ(froxel.bytes(), (std::map<std::string, std::int64_t>{{"froxels", 7 * 5 * 20 * 16}}));
}

TEST(Froxel, MoreThanAVolumeMayHaveAreRefusedByTheOptionsName) {
  gpu::Limits limits = tests::gpu_context().limits();
  limits.max_volume_size = 100;
  EXPECT_EQ(media::froxel_count(limits, {.tile = 2}, {200, 151}), glm::ivec3(100, 76, 64));
  tests::expect_error(scene::ExitCode::driver, {"froxel:tile=2:slices=64: 101 x 5 x 64", "100"}, [&] {
    media::froxel_count(limits, {.tile = 2}, {202, 10});
  });
  tests::expect_error(scene::ExitCode::driver, {"froxel:tile=8:slices=101: 1 x 1 x 101", "100"}, [&] {
    media::froxel_count(limits, {.slices = 101}, {8, 8});
  });
}

TEST(Froxel, RefusesLobesThatStepsCannotFollow) {
  scene::View view = tests::clutter_view(tests::k_kinds_of_light[0], 8);
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = 0.996f;
  EXPECT_TRUE(FroxelOptions{}.refusal(view));
}

}  // namespace
}  // namespace airlight
