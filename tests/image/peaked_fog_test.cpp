#include <cmath>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "scene/error.h"
#include "scene/import.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/shared.h"

/// Fog whose integrand is far from smooth: narrow lobes of the phase function, heavy extinction.
namespace airlight {
namespace {

using media::VsvIntegral;
using scene::PhaseFunction;

/// The light in view, behind the camera, beside it.
constexpr glm::dvec3 k_lights[] = {{0, 0, 0}, {0, 0.1, 10}, {4, 1, 4}};

scene::View empty_view(glm::dvec3 light) {
  scene::View view = tests::view_of(tests::builtin("empty"), {48, 48});
  view.lights[0].position = light;
  return view;
}

/// Without shadows, only φ matters.
tests::VsvSettings settings(VsvIntegral integral) {
  return {.resolution = {64, 128, 512}, .integral = integral, .shadow_map = 64};
}

class EmptyFogBy : public testing::TestWithParam<VsvIntegral> {
 protected:
  /// Expects an error below 1 % of the mean, of any view below.
  void expect_near_truth(const scene::View& view) {
    const auto truth = reference::Reference({}, view).exact();
    const auto error =
        tests::error_of(tests::render_vsv({}, view, settings(GetParam())).airlight, truth.radiance);
    EXPECT_LT(error.rrmse, 0.01);
    EXPECT_LT(std::abs(error.bias), 1e-3);
    worst_ = std::max(worst_, error.rrmse);
  }
  void TearDown() override { RecordProperty("rrmse", std::to_string(worst_)); }

 private:
  double worst_ = 0.0;
};

TEST_P(EmptyFogBy, FollowsNarrowLobes) {
  for (const float g : {0.5f, -0.5f, 0.95f, -0.95f, 0.99f, -0.99f}) {
    for (const glm::dvec3& light : k_lights) {
      SCOPED_TRACE(testing::Message() << "g " << g << ", light at " << light.z);
      scene::View view = empty_view(light);
      view.medium.phase = PhaseFunction::henyey_greenstein;
      view.medium.g = g;
      expect_near_truth(view);
    }
  }
  scene::View view = empty_view(k_lights[0]);
  view.medium.phase = PhaseFunction::hoffman_preetham;
  view.medium.g = 0.99f;
  view.medium.rayleigh_weight = 0.3f;
  expect_near_truth(view);
}

TEST_P(EmptyFogBy, FollowsExtinctionFromNoneToAll) {
  for (const float sigma : {0.001f, 2.0f, 14.0f}) {
    for (const glm::dvec3& light : k_lights) {
      SCOPED_TRACE(testing::Message() << "sigma " << sigma << ", light at " << light.z);
      scene::View view = empty_view(light);
      view.medium.sigma_s = glm::vec3(sigma);
      expect_near_truth(view);
    }
  }
  // And in colours of which one is bright and one is all but black.
  scene::View view = empty_view(k_lights[0]);
  view.medium.sigma_s = {0.1f, 2.0f, 10.0f};
  const auto truth = reference::Reference({}, view).exact();
  const auto image = tests::render_vsv({}, view, settings(GetParam())).airlight;
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(image[i][channel] / truth.radiance[i][channel], 1.0f, 0.01f) << i << " " << channel;
  }
}

TEST_P(EmptyFogBy, IsBlackWhereNoLightArrives) {
  for (const float sigma : {30.0f, 1000.0f}) {
    scene::View view = empty_view(k_lights[0]);
    view.medium.sigma_s = glm::vec3(sigma);
    for (const glm::vec3& value : tests::render_vsv({}, view, settings(GetParam())).airlight)
      EXPECT_EQ(value, glm::vec3(0.0f));
  }
}

INSTANTIATE_TEST_SUITE_P(Integrals, EmptyFogBy,
                         testing::Values(VsvIntegral::table, VsvIntegral::quadrature, VsvIntegral::riemann),
                         [](const auto& test) { return tests::name_of(test.param); });

TEST(HeavyFog, KeepsItsDigitsWhereOnlyWhatLiesFarIsLit) {
  // What is lit lies e^−16 and more deeper than what is not: an integral counted from the eye would not hold
  // it beside that.
  const scene::Scene& scene = tests::builtin("half-space");
  scene::View view = tests::view_of(scene, {32, 32});
  view.camera.eye = {-3, -1, 0};
  view.camera.target = {3, -1.2, 0};
  view.lights[0].position = {0, 2, 0};
  view.medium.sigma_s = glm::vec3(10.0f);
  const tests::Truth truth = tests::trace(scene.geometry, view);
  const auto error = tests::error_of(tests::render_vsv(scene.geometry, view), truth);
  // The shadow's edge is misplaced by up to half a cell of φ, here up to an optical depth of 0.3.
  EXPECT_LT(error.rrmse, 0.15);
  EXPECT_LT(std::abs(error.bias), 0.01);
  RecordProperty("rrmse", std::to_string(error.rrmse));
}

/// A lobe is followed among shadows too; their edges are placed to half a cell, of which a lobe may be no
/// wider.
TEST(Lobes, AmongColumns) {
  const std::filesystem::path file = tests::shared_file("scenes/trial_cols.obj");
  AIRLIGHT_NEEDS(file);
  const scene::Scene scene = scene::import_scene(file);
  scene::View view;
  view.camera.eye = {0.3, 1.4, 4.5};
  view.camera.target = {0, 1.5, -1};
  view.lights[0].position = {1.1, 1.9, -1.5};
  view.lights[0].intensity = glm::vec3(20.0f);
  view.medium.sigma_s = glm::vec3(0.05f);
  view.medium.phase = PhaseFunction::henyey_greenstein;
  view.size = {64, 64};
  for (const float g : {0.5f, -0.5f, 0.95f, -0.95f, 0.99f, -0.99f}) {
    view.medium.g = g;
    const tests::Truth truth = tests::trace(scene.geometry, view);
    for (const VsvIntegral integral : {VsvIntegral::table, VsvIntegral::quadrature, VsvIntegral::riemann}) {
      const auto error =
          tests::error_of(tests::render_vsv(scene.geometry, view, {.integral = integral}), truth);
      EXPECT_LT(error.rrmse, 0.01) << "g " << g;
      EXPECT_LT(std::abs(error.bias), 2e-3) << "g " << g;
    }
    const auto march = reference::Reference(scene.geometry, view).march(512, reference::RayMode::packet);
    EXPECT_LT(tests::error_of(march.radiance, truth.airlight.radiance).rrmse, 0.01) << "march, g " << g;
  }
}

TEST(Lobes, TooNarrowOnesAreRefused) {
  scene::View view = empty_view(k_lights[0]);
  view.medium.phase = PhaseFunction::hoffman_preetham;
  for (const float g : {0.994f, -0.994f}) {
    view.medium.g = g;
    EXPECT_FALSE(media::VsvOptions{}.refusal(view)) << g;
  }
  for (const float g : {0.996f, -0.996f}) {
    view.medium.g = g;
    const auto refusal = media::VsvOptions{}.refusal(view);
    ASSERT_TRUE(refusal);
    EXPECT_NE(refusal->problem.find("0.996"), std::string::npos) << refusal->problem;
    EXPECT_NE(refusal->problem.find("0.995"), std::string::npos) << refusal->problem;
  }
  view.medium.phase = PhaseFunction::rayleigh;
  EXPECT_FALSE(media::VsvOptions{}.refusal(view));
}

}  // namespace
}  // namespace airlight
