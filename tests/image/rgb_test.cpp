#include <algorithm>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/scenes.h"

namespace airlight {
namespace {

class RgbMedium : public testing::TestWithParam<media::VsvIntegral> {};

TEST_P(RgbMedium, GivesEachChannelWhatAGreyMediumOfItsOwnWould) {
  const scene::Scene& scene = tests::builtin("cornell");
  scene::View view = tests::view_of(scene, {48, 48});
  view.medium.sigma_s = {0.1f, 0.4f, 0.8f};
  view.medium.sigma_a = {0.3f, 0.0f, 0.1f};
  view.lights[0].intensity = {1, 2, 3};
  // Equal cells, so that the bits are the same in all four runs.
  const tests::VsvSettings settings{.resolution = {128, 256, 256},
                                    .integral = GetParam(),
                                    .shadow_map = 512,
                                    .phi_cells = media::PhiCells::equal};
  const frame::FrameImages coloured = tests::render_vsv(scene.geometry, view, settings);
  for (int channel = 0; channel < 3; ++channel) {
    scene::View grey = view;
    grey.medium.sigma_s = glm::vec3(view.medium.sigma_s[channel]);
    grey.medium.sigma_a = glm::vec3(view.medium.sigma_a[channel]);
    grey.lights[0].intensity = glm::vec3(view.lights[0].intensity[channel]);
    const frame::FrameImages alone = tests::render_vsv(scene.geometry, grey, settings);
    double largest = 0.0;
    for (const glm::vec3& value : alone.airlight) largest = std::max(largest, static_cast<double>(value.x));
    for (std::size_t i = 0; i < alone.airlight.size(); ++i) {
      EXPECT_EQ(alone.airlight[i].x, alone.airlight[i].y);
      EXPECT_EQ(alone.airlight[i].x, alone.airlight[i].z);
      // A difference of table entries keeps the rounding of the entries.
      EXPECT_NEAR(static_cast<double>(coloured.airlight[i][channel]),
                  static_cast<double>(alone.airlight[i].x), 1e-6 * largest);
      EXPECT_NEAR(static_cast<double>(coloured.radiance[i][channel]),
                  static_cast<double>(alone.radiance[i][channel]), 2e-6 * largest);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Integrals, RgbMedium,
                         testing::Values(media::VsvIntegral::table, media::VsvIntegral::riemann,
                                         media::VsvIntegral::factored));

TEST(RgbMediumReference, AgreesInEveryChannel) {
  const scene::Scene& scene = tests::builtin("cornell");
  scene::View view = tests::view_of(scene, {64, 64});
  view.medium.sigma_s = {0.1f, 0.4f, 0.8f};
  view.medium.sigma_a = {0.3f, 0.0f, 0.1f};
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = 0.5f;
  const tests::Truth truth = tests::trace(scene.geometry, view);
  const frame::FrameImages images = tests::render_vsv(scene.geometry, view);
  for (int channel = 0; channel < 3; ++channel) {
    double sum = 0.0, expected = 0.0;
    for (std::size_t i = 0; i < images.airlight.size(); ++i) {
      sum += static_cast<double>(images.airlight[i][channel]);
      expected += static_cast<double>(truth.airlight.radiance[i][channel]);
    }
    EXPECT_NEAR(sum / expected, 1.0, 2e-3) << channel;
  }
  EXPECT_LT(tests::error_of(images, truth).rrmse, 0.01) << "256 × 1024 × 512 cells";
}

}  // namespace
}  // namespace airlight
