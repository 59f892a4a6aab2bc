#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "quality/image_io.h"
#include "reference/reference.h"
#include "scene/import.h"
#include "support/shared.h"

/// Against Blender Cycles, a renderer that shares nothing with Airlight. Its images, views and noise (0.5 %
/// rms a pixel) are described in truth/README.md of the shared data.
namespace airlight::reference {
namespace {

struct Truth {
  const char* image;
  const char* scene;
  glm::dvec3 eye, target;
  double fov_degrees;
  glm::dvec3 light;
  float intensity, sigma_s, sigma_a, g;
  int samples;  ///< as many as the scene's detail asks for
};

void PrintTo(const Truth& truth, std::ostream* stream) {
  *stream << truth.image;
}

// clang-format off
const Truth k_airlight[] = {
    {"cornell_airlight", "cornell_box_36", {0, 1, 3.6}, {0, 1, 0}, 40, {0.2, 1.85, 0.1}, 2, 0.3f, 0.05f, 0, 128},
    {"fence_airlight", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {-0.2, 0.7, -1.0}, 8, 0.25f, 0, 0, 256},
    {"maple_airlight", "maple_198k", {-2, 2, 11}, {0.5, 3.8, 0}, 50, {1.5, 5, -5}, 200, 0.06f, 0, 0.5f, 1024},
    {"sponza_airlight", "sponza_262k", {-12, 3, -0.5}, {0, 5, 0}, 60, {3, 7, 0}, 300, 0.04f, 0.01f, 0, 128},
};
const Truth k_full =
    {"fence_full", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {1.5, 1.2, 1.8}, 8, 0.25f, 0, 0, 128};
// clang-format on

std::filesystem::path image_file(const Truth& truth) {
  return airlight::tests::shared_file("truth/" + std::string(truth.image) + ".exr");
}
std::filesystem::path scene_file(const Truth& truth) {
  return airlight::tests::shared_file("scenes/" + std::string(truth.scene) + ".glb");
}

Reference make_reference(const Truth& truth) {
  scene::View view;
  view.camera.eye = truth.eye;
  view.camera.target = truth.target;
  view.camera.vertical_fov_degrees = truth.fov_degrees;
  view.light.position = truth.light;
  view.light.intensity = glm::vec3(truth.intensity);
  view.medium.sigma_s = glm::vec3(truth.sigma_s);
  view.medium.sigma_a = glm::vec3(truth.sigma_a);
  if (truth.g != 0) view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = truth.g;
  view.size = {256, 256};
  return Reference(scene::import_scene(scene_file(truth)).geometry, view);
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

double percentile(std::vector<float> values, double percent) {
  std::sort(values.begin(), values.end());
  return static_cast<double>(
      values[static_cast<std::size_t>(percent / 100 * static_cast<double>(values.size() - 1))]);
}

class AirlightTruth : public testing::TestWithParam<Truth> {};

TEST_P(AirlightTruth, MeanAndPercentilesAgree) {
  const Truth& truth = GetParam();
  AIRLIGHT_NEEDS(image_file(truth));
  AIRLIGHT_NEEDS(scene_file(truth));
  const std::vector<float> expected = quality::read_exr(image_file(truth)).channels.at("R");
  const AirlightImage image = make_reference(truth).converged(truth.samples);
  std::vector<float> red;
  for (const glm::vec3& radiance : image.radiance) red.push_back(radiance.r);
  ASSERT_EQ(red.size(), expected.size());

  RecordProperty("mean_ratio", std::to_string(mean(red) / mean(expected)));
  EXPECT_NEAR(mean(red) / mean(expected), 1.0, 0.005);
  const std::pair<int, const char*> percents[] = {{10, "p10"}, {25, "p25"}, {50, "p50"},
                                                  {75, "p75"}, {90, "p90"}, {99, "p99"}};
  for (const auto& [percent, name] : percents) {
    const double ratio = percentile(red, percent) / percentile(expected, percent);
    RecordProperty(name, std::to_string(ratio));
    EXPECT_NEAR(ratio, 1.0, 0.015) << "percentile " << percent;
  }
  // Where an edge crosses a pixel centre the two may see different surfaces: structure is judged by most
  // pixels, not by all.
  std::vector<float> differences;
  for (std::size_t i = 0; i < red.size(); ++i) differences.push_back(std::abs(red[i] / expected[i] - 1));
  RecordProperty("median_difference", std::to_string(percentile(differences, 50)));
  RecordProperty("p90_difference", std::to_string(percentile(differences, 90)));
  EXPECT_LT(percentile(differences, 50), 0.015);
  EXPECT_LT(percentile(differences, 90), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Cycles, AirlightTruth, testing::ValuesIn(k_airlight),
                         [](const auto& test) { return std::string(test.param.image); });

TEST(SurfaceTruth, ShadowsAreBlackButForTheAirlight) {
  AIRLIGHT_NEEDS(image_file(k_full));
  AIRLIGHT_NEEDS(scene_file(k_full));
  const std::vector<float> expected = quality::read_exr(image_file(k_full)).channels.at("R");
  const Reference reference = make_reference(k_full);
  const AirlightImage airlight = reference.converged(k_full.samples);
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

}  // namespace
}  // namespace airlight::reference
