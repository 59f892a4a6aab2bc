#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "quality/image_io.h"
#include "scene/import.h"
#include "support/render.h"
#include "support/shared.h"

/// Against Blender Cycles, a renderer that shares nothing with Airlight. Its images, views and noise (0.5 %
/// rms a pixel) are described in truth/README.md of the shared data. How the reference compares is in
/// tests/unit/reference/truth_test.cpp.
namespace airlight {
namespace {

struct Truth {
  const char* image;
  const char* scene;
  glm::dvec3 eye, target;
  double fov_degrees;
  glm::dvec3 light;
  float intensity, sigma_s, sigma_a, g;
  float albedo;
};

void PrintTo(const Truth& truth, std::ostream* stream) {
  *stream << truth.image;
}

// clang-format off
const Truth k_images[] = {
    {"cornell_airlight", "cornell_box_36", {0, 1, 3.6}, {0, 1, 0}, 40, {0.2, 1.85, 0.1}, 2, 0.3f, 0.05f, 0, 0},
    {"fence_airlight", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {-0.2, 0.7, -1.0}, 8, 0.25f, 0, 0, 0},
    {"fence_full", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {1.5, 1.2, 1.8}, 8, 0.25f, 0, 0, 0.5f},
    {"maple_airlight", "maple_198k", {-2, 2, 11}, {0.5, 3.8, 0}, 50, {1.5, 5, -5}, 200, 0.06f, 0, 0.5f, 0},
    {"sponza_airlight", "sponza_262k", {-12, 3, -0.5}, {0, 5, 0}, 60, {3, 7, 0}, 300, 0.04f, 0.01f, 0, 0},
};
// clang-format on

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

class VsvTruth : public testing::TestWithParam<Truth> {};

TEST_P(VsvTruth, MeanAndPercentilesAgree) {
  const Truth& truth = GetParam();
  const std::filesystem::path image_file = tests::shared_file(fmt::format("truth/{}.exr", truth.image));
  const std::filesystem::path scene_file = tests::shared_file(fmt::format("scenes/{}.glb", truth.scene));
  AIRLIGHT_NEEDS(image_file);
  AIRLIGHT_NEEDS(scene_file);
  scene::Scene scene = scene::import_scene(scene_file);
  for (scene::Material& material : scene.geometry.materials) material.albedo = glm::vec3(truth.albedo);
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

  const tests::VsvSettings settings{
      .resolution = {512, 2048, 512}, .shadow_map = 2048, .surface_shadows = true};
  const frame::FrameImages images = tests::render_vsv(scene.geometry, view, settings);
  const std::vector<float> expected = quality::read_exr(image_file).channels.at("R");
  std::vector<float> red;
  for (const glm::vec3& radiance : images.radiance) red.push_back(radiance.r);
  ASSERT_EQ(red.size(), expected.size());
  RecordProperty("mean_ratio", std::to_string(mean(red) / mean(expected)));
  EXPECT_NEAR(mean(red) / mean(expected), 1.0, 0.005);
  for (int percent : {10, 25, 50, 75, 90, 99}) {
    const double ratio = percentile(red, percent) / percentile(expected, percent);
    RecordProperty(fmt::format("p{}", percent), fmt::format("{:.4f}", ratio));
    EXPECT_NEAR(ratio, 1.0, 0.02) << "percentile " << percent;
  }
  // Where an edge crosses a pixel centre the two may see different surfaces: structure is judged by most
  // pixels, not by all.
  std::vector<float> differences;
  for (std::size_t i = 0; i < red.size(); ++i) differences.push_back(std::abs(red[i] / expected[i] - 1));
  RecordProperty("median_difference", std::to_string(percentile(differences, 50)));
  EXPECT_LT(percentile(differences, 50), 0.02);
  EXPECT_LT(percentile(differences, 85), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Cycles, VsvTruth, testing::ValuesIn(k_images),
                         [](const auto& test) { return std::string(test.param.image); });

}  // namespace
}  // namespace airlight
