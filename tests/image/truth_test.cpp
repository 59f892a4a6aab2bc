#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "quality/image_io.h"
#include "quality/methods.h"
#include "quality/traced.h"
#include "scene/import.h"
#include "support/render.h"
#include "support/truth.h"

/// Against Blender Cycles, a renderer that shares nothing with Airlight. Its images, views and noise (0.5 %
/// rms a pixel) are described in truth/README.md of the shared data. How the reference compares is in
/// tests/unit/reference/truth_test.cpp.
namespace airlight {
namespace {

using tests::CyclesImage, tests::mean, tests::percentile;

class VsvTruth : public testing::TestWithParam<CyclesImage> {};

TEST_P(VsvTruth, MeanAndPercentilesAgree) {
  const CyclesImage& truth = GetParam();
  AIRLIGHT_NEEDS(truth.image_file());
  AIRLIGHT_NEEDS(truth.scene_file());
  scene::Scene scene = scene::import_scene(truth.scene_file());
  for (scene::Material& material : scene.geometry.materials) material.albedo = glm::vec3(truth.albedo);
  const tests::VsvSettings settings{
      .resolution = {512, 2048, 512}, .shadow_map = 2048, .surface_shadows = true};
  const frame::FrameImages images = tests::render_vsv(scene.geometry, truth.view(), settings);
  const std::vector<float> expected = quality::read_exr(truth.image_file()).channels.at("R");
  std::vector<float> red;
  for (const glm::vec3& radiance : images.radiance) red.push_back(radiance.r);
  ASSERT_EQ(red.size(), expected.size());
  RecordProperty("mean_ratio", std::to_string(mean(red) / mean(expected)));
  EXPECT_NEAR(mean(red) / mean(expected), 1.0, 0.005);
  for (int percent : {10, 25, 50, 75, 90, 99}) {
    if (percentile(expected, percent) == 0) {  // in shadow from end to end
      EXPECT_EQ(percentile(red, percent), 0) << "percentile " << percent;
      continue;
    }
    const double ratio = percentile(red, percent) / percentile(expected, percent);
    RecordProperty(fmt::format("p{}", percent), fmt::format("{:.4f}", ratio));
    EXPECT_NEAR(ratio, 1.0, 0.02) << "percentile " << percent;
  }
  // Where an edge crosses a pixel centre the two may see different surfaces: structure is judged by most
  // pixels, not by all.
  std::vector<float> differences;
  for (std::size_t i = 0; i < red.size(); ++i) {
    const float difference = std::abs(red[i] - expected[i]);
    differences.push_back(difference == 0 ? 0 : difference / expected[i]);
  }
  RecordProperty("median_difference", std::to_string(percentile(differences, 50)));
  EXPECT_LT(percentile(differences, 50), 0.02);
  EXPECT_LT(percentile(differences, 85), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Cycles, VsvTruth, testing::ValuesIn(tests::all_cycles_images()),
                         [](const auto& test) { return std::string(test.param.image); });

TEST(ReferenceTruth, MeanOfThreeLightsAgrees) {
  const CyclesImage& truth = tests::k_cycles_three_full;
  AIRLIGHT_NEEDS(truth.image_file());
  AIRLIGHT_NEEDS(truth.scene_file());
  scene::Scene scene = scene::import_scene(truth.scene_file());
  scene::override_albedo(scene.geometry, glm::vec3(truth.albedo));
  const scene::View view = truth.view();
  quality::SharedReference reference(scene.geometry, view, {});
  const auto airlight = quality::parse_volumes("reference")[0].make(tests::gpu_context(), reference);
  const auto shadow = quality::parse_surfaces("reference")[0].make(tests::gpu_context(), reference);
  frame::Frame frame(tests::gpu_context(), scene.geometry, 16);
  gpu::StageTimer off(nullptr);
  frame.render(view, *shadow, *airlight, off);
  std::vector<float> red;
  for (const glm::vec3& radiance : frame.read().radiance) red.push_back(radiance.r);
  const std::vector<float> expected = quality::read_exr(truth.image_file()).channels.at("R");
  RecordProperty("mean_ratio", std::to_string(mean(red) / mean(expected)));
  EXPECT_NEAR(mean(red) / mean(expected), 1.0, 0.005);
}

}  // namespace
}  // namespace airlight
