#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/light_texture.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/view_rays.h"
#include "unit/reference/fixtures.h"

/// Point lights and a layer of fog. The truth is the reference, which tests/unit/reference/layer_test.cpp
/// holds to the integral over the distance.
namespace airlight {
namespace {

using media::VsvIntegral;

/// Where eye and lamp lie; the layer's top is at 0.
struct Heights {
  const char* name;
  double eye, lamp;
};
void PrintTo(const Heights& heights, std::ostream* stream) {
  *stream << heights.name;
}

constexpr Heights k_both_in{"BothIn", -0.7, -0.3};
constexpr Heights k_entered[] = {{"LampAbove", -0.7, 0.6}, {"EyeAbove", 0.8, -0.5}, {"BothAbove", 0.9, 0.4}};

/// Level or, with `pitch`, tilted [rad]; the lamp ahead, `distance` away, or behind the eye where that is
/// negative.
scene::View layer_view(const Heights& heights, double pitch = 0.0, double distance = 4.0) {
  scene::View view;
  view.camera.eye = {0.1, heights.eye, 4.0};
  view.camera.target = view.camera.eye + glm::dvec3(0, std::sin(pitch), -std::cos(pitch));
  view.camera.vertical_fov_degrees = 70;
  view.lights[0] = scene::point_light("", {0.3, heights.lamp, 4.0 - distance}, {3, 2, 1});
  view.medium = {.sigma_s = {0.3f, 0.1f, 0.6f}, .sigma_a = {0.0f, 0.2f, 0.1f}, .top = 0.0};
  view.size = {32, 32};
  return view;
}

tests::VsvSettings by(VsvIntegral integral) {
  return {.resolution = {256, 1024, 512}, .integral = integral};
}

/// Expects every pixel of an image without occluders to be right to so much of the truth, and 1e-7 of the
/// brightest.
void expect_empty_layer(const scene::View& view, VsvIntegral integral, double tolerance) {
  const auto truth = reference::Reference({}, view).exact().radiance;
  const auto image = tests::render_vsv({}, view, by(integral)).airlight;
  const std::span<const float> values = quality::channels_of(truth);
  const double rounding = 1e-7 * static_cast<double>(*std::max_element(values.begin(), values.end()));
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const auto expected = static_cast<double>(truth[i][channel]);
      EXPECT_NEAR(static_cast<double>(image[i][channel]), expected, tolerance * expected + rounding)
          << "pixel " << i << ", channel " << channel;
    }
  }
}

TEST(EmptyLayer, AroundEyeAndLampIsRightByEveryIntegral) {
  for (const VsvIntegral integral :
       {VsvIntegral::table, VsvIntegral::quadrature, VsvIntegral::riemann, VsvIntegral::factored}) {
    for (const double pitch : {0.0, 1.2, -1.2}) {
      for (const double distance : {4.0, -3.0})
        expect_empty_layer(layer_view(k_both_in, pitch, distance), integral, 2e-3);
    }
  }
}

/// They take light that depends on θ.
constexpr VsvIntegral k_of_all_light[] = {VsvIntegral::quadrature, VsvIntegral::riemann};

class EnteredLayer : public testing::TestWithParam<Heights> {};
INSTANTIATE_TEST_SUITE_P(Heights, EnteredLayer, testing::ValuesIn(k_entered),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(EnteredLayer, IsRightWithoutOccluders) {
  for (const double pitch : {0.0, 1.2, -1.2}) {
    for (const double distance : {4.0, -3.0}) {
      for (const VsvIntegral integral : k_of_all_light)
        expect_empty_layer(layer_view(GetParam(), pitch, distance), integral, 3e-3);
    }
  }
}

TEST_P(EnteredLayer, IsRightInHeavyFogAndNarrowLobes) {
  for (const float g : {0.95f, -0.95f}) {
    // Looking down: where a nearly level ray enters the layer ten times as far away as the lamp is, a
    // rounding of φ is a centimetre of its length, and some per cent of such fog.
    scene::View view = layer_view(GetParam(), -0.75);
    view.medium.phase = scene::PhaseFunction::henyey_greenstein;
    view.medium.g = g;
    for (const VsvIntegral integral : k_of_all_light) expect_empty_layer(view, integral, 5e-3);
    view.medium.sigma_s = glm::vec3(6.0f, 0.01f, 15.0f);
    // Some rays enter ten times D away, where φ has few digits for how deep they are.
    for (const VsvIntegral integral : k_of_all_light) expect_empty_layer(view, integral, 0.02);
  }
}

TEST_P(EnteredLayer, IsDarkWhereRaysNeverEnterIt) {
  const scene::View view = layer_view(GetParam(), 0.4);
  const auto image = tests::render_vsv({}, view).airlight;
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  int above = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const bool enters = view.camera.eye.y < 0 || tests::pixel_ray(camera, view.size, i).y < 0;
    EXPECT_EQ(image[i] == glm::vec3(0.0f), !enters) << i;
    above += enters ? 0 : 1;
  }
  EXPECT_EQ(above > 300, GetParam().eye > 0);
}

TEST_P(EnteredLayer, IsRefusedByWhatLooksUpATable) {
  const scene::View view = layer_view(GetParam());
  for (const VsvIntegral integral : {VsvIntegral::table, VsvIntegral::factored}) {
    const auto refusal = media::VsvOptions{.integral = integral}.refusal(view);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->where, integral == VsvIntegral::table ? "integral=table" : "integral=factored");
    EXPECT_EQ(refusal->remedy, "use vsv:integral=quadrature");
    EXPECT_FALSE(media::VsvOptions{.integral = integral}.refusal(layer_view(k_both_in)));
  }
  for (const VsvIntegral integral : k_of_all_light)
    EXPECT_FALSE(media::VsvOptions{.integral = integral}.refusal(view));
  EXPECT_EQ(media::VsvOptions{}.used_integral(view), VsvIntegral::quadrature);
  EXPECT_EQ(media::VsvOptions{}.used_integral(layer_view(k_both_in)), VsvIntegral::table);
  scene::View sun = view;
  sun.lights[0] = scene::sun("", {0.3, 1, 0.2}, {1, 1, 1});
  EXPECT_EQ(media::VsvOptions{}.used_integral(sun), VsvIntegral::table);
}

/// A lamp whose light depends on the direction.
std::shared_ptr<const scene::LightTexture> window_panes() {
  std::vector<glm::vec3> texels;
  for (int i = 0; i < 16 * 8; ++i) texels.emplace_back(1.0f + 0.5f * std::sin(0.7f * static_cast<float>(i)));
  return std::make_shared<scene::LightTexture>("panes", glm::ivec2(16, 8), std::move(texels));
}

TEST_P(EnteredLayer, TakesALightTexture) {
  scene::View view = layer_view(GetParam());
  view.lights[0].texture = window_panes();
  const auto truth = reference::Reference({}, view).exact().radiance;
  for (const VsvIntegral integral : k_of_all_light) {
    const auto error = tests::error_of(tests::render_vsv({}, view, by(integral)).airlight, truth);
    EXPECT_LT(error.rrmse, integral == VsvIntegral::riemann ? 0.01 : 1e-3) << tests::name_of(integral);
    RecordProperty(tests::name_of(integral), std::to_string(error.rrmse));
  }
}

/// Slats all over, above the layer and in it.
const scene::Geometry& slats() {
  static const scene::Geometry geometry = reference::tests::clutter(40);
  return geometry;
}

double error_among_slats(const scene::View& view, const tests::VsvSettings& settings, double bias = 2e-3) {
  const tests::Truth truth = tests::trace(slats(), view);
  const auto error = tests::error_of(tests::render_vsv(slats(), view, settings), truth);
  EXPECT_LT(std::abs(error.bias), bias);
  testing::Test::RecordProperty("rrmse", std::to_string(error.rrmse));
  return error.rrmse;
}

TEST(LayerAmongSlats, AroundEyeAndLampIsAsRightAsEndlessFog) {
  for (const VsvIntegral integral : {VsvIntegral::table, VsvIntegral::quadrature, VsvIntegral::riemann}) {
    scene::View view = layer_view(k_both_in);
    view.size = {64, 64};
    const double in_layer = error_among_slats(view, by(integral));
    view.medium.top = {};
    const double endless = error_among_slats(view, by(integral));
    // Misplaced edges of shadow; without the fog above, the same edges weigh more.
    EXPECT_LT(in_layer, 2 * endless);
    EXPECT_LT(endless, 0.02);
  }
}

TEST_P(EnteredLayer, IsRightAmongSlats) {
  scene::View view = layer_view(GetParam());
  view.size = {64, 64};
  for (const VsvIntegral integral : k_of_all_light) EXPECT_LT(error_among_slats(view, by(integral)), 0.02);
  tests::VsvSettings conservative = by(VsvIntegral::quadrature);
  conservative.populate = epipolar::Populate::conservative;
  EXPECT_LT(error_among_slats(view, conservative, 0.01), 0.02);  // shadows only grow
  // Every cell in steps that follow the integrand.
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = 0.85f;
  for (const VsvIntegral integral : k_of_all_light) EXPECT_LT(error_among_slats(view, by(integral)), 0.03);
}

}  // namespace
}  // namespace airlight
