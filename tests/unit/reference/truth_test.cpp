#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "quality/image_io.h"
#include "reference/reference.h"
#include "scene/import.h"
#include "support/truth.h"

/// Against Blender Cycles, a renderer that shares nothing with Airlight. Its images, views and noise (0.5 %
/// rms a pixel) are described in truth/README.md of the shared data.
namespace airlight::reference {
namespace {

using airlight::tests::k_cycles_airlight, airlight::tests::k_cycles_full,
    airlight::tests::k_cycles_spot_airlight, airlight::tests::k_cycles_sun_airlight,
    airlight::tests::k_cycles_sun_full, airlight::tests::mean, airlight::tests::percentile;
using Truth = airlight::tests::CyclesImage;

Reference make_reference(const Truth& truth) {
  return Reference(scene::import_scene(truth.scene_file()).geometry, truth.view());
}

class AirlightTruth : public testing::TestWithParam<Truth> {};

TEST_P(AirlightTruth, MeanAndPercentilesAgree) {
  const Truth& truth = GetParam();
  AIRLIGHT_NEEDS(truth.image_file());
  AIRLIGHT_NEEDS(truth.scene_file());
  const std::vector<float> expected = quality::read_exr(truth.image_file()).channels.at("R");
  const AirlightImage image = make_reference(truth).exact();
  std::vector<float> red;
  for (const glm::vec3& radiance : image.radiance) red.push_back(radiance.r);
  ASSERT_EQ(red.size(), expected.size());

  RecordProperty("mean_ratio", std::to_string(mean(red) / mean(expected)));
  EXPECT_NEAR(mean(red) / mean(expected), 1.0, 0.001);
  const std::pair<int, const char*> percents[] = {{10, "p10"}, {25, "p25"}, {50, "p50"},
                                                  {75, "p75"}, {90, "p90"}, {99, "p99"}};
  for (const auto& [percent, name] : percents) {
    const double value = percentile(red, percent), expected_value = percentile(expected, percent);
    RecordProperty(name, std::to_string(value / expected_value));
    EXPECT_NEAR(value, expected_value, 0.015 * expected_value) << "percentile " << percent;
  }
  // Where an edge crosses a pixel centre the two may see different surfaces: structure is judged by most
  // pixels, not by all.
  std::vector<float> differences;
  for (std::size_t i = 0; i < red.size(); ++i)
    differences.push_back(red[i] == expected[i] ? 0.0f : std::abs(red[i] / expected[i] - 1));
  RecordProperty("median_difference", std::to_string(percentile(differences, 50)));
  RecordProperty("p90_difference", std::to_string(percentile(differences, 90)));
  EXPECT_LT(percentile(differences, 50), 0.015);
  EXPECT_LT(percentile(differences, 90), 0.05);
}

std::string name(const testing::TestParamInfo<Truth>& test) {
  return test.param.image;
}

INSTANTIATE_TEST_SUITE_P(Cycles, AirlightTruth, testing::ValuesIn(k_cycles_airlight), name);
INSTANTIATE_TEST_SUITE_P(CyclesSpot, AirlightTruth, testing::Values(k_cycles_spot_airlight), name);
INSTANTIATE_TEST_SUITE_P(CyclesSun, AirlightTruth, testing::ValuesIn(k_cycles_sun_airlight), name);

class SurfaceTruth : public testing::TestWithParam<Truth> {};

TEST_P(SurfaceTruth, ShadowsAreBlackButForTheAirlight) {
  const Truth& truth = GetParam();
  AIRLIGHT_NEEDS(truth.image_file());
  AIRLIGHT_NEEDS(truth.scene_file());
  const std::vector<float> expected = quality::read_exr(truth.image_file()).channels.at("R");
  const Reference reference = make_reference(truth);
  const AirlightImage airlight = reference.exact();
  const SurfaceImage surfaces = reference.surfaces();
  std::vector<float> lit, dark, none;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const float surface_radiance = expected[i] / airlight.radiance[i].r - 1;
    (surfaces.distance[i] == 0 ? none : surfaces.visibility[i] > 0 ? lit : dark).push_back(surface_radiance);
  }
  ASSERT_GT(lit.size(), 1000u);
  ASSERT_GT(dark.size(), 300u);
  for (const std::vector<float>& black : {dark, none}) {
    EXPECT_NEAR(mean(black), 0.0, 0.01);
    EXPECT_LT(percentile(black, 90), 0.01);
  }
  EXPECT_GT(percentile(lit, 25), 0.05) << "most surfaces that see the light shine";
  RecordProperty("dark_mean", std::to_string(mean(dark)));
  RecordProperty("none_mean", std::to_string(mean(none)));
  RecordProperty("dark_90", std::to_string(percentile(dark, 90)));
  RecordProperty("lit_25", std::to_string(percentile(lit, 25)));
}

INSTANTIATE_TEST_SUITE_P(Cycles, SurfaceTruth, testing::Values(k_cycles_full, k_cycles_sun_full), name);

}  // namespace
}  // namespace airlight::reference
