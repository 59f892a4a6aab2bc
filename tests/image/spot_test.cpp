#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/light_texture.h"
#include "support/render.h"
#include "support/view_rays.h"
#include "unit/reference/fixtures.h"

/// Spots and lights with a range, in fog without occluders, against a sum over the view ray that knows
/// nothing of where a cone is cut.
namespace airlight {
namespace {

using media::VsvIntegral;

constexpr double k_degree = std::numbers::pi / 180;

/// What a light sends in a unit direction as far as r, relative to its intensity.
double share(const scene::Light& light, glm::dvec3 direction, double r) {
  double share = 1.0;
  if (light.cone) {
    // cos a − cos b = 2 sin((b − a)/2) sin((b + a)/2)
    const auto fall = [](double from, double to) {
      return 2 * std::sin(0.5 * (to - from)) * std::sin(0.5 * (to + from));
    };
    const double angle = std::atan2(glm::length(glm::cross(direction, light.cone->axis)),
                                    glm::dot(direction, light.cone->axis));
    const double width = fall(light.cone->inner, light.cone->outer);
    const double above = fall(angle, light.cone->outer);
    const double ramp = width > 0 ? std::clamp(above / width, 0.0, 1.0) : above >= 0 ? 1.0 : 0.0;
    share *= ramp * ramp;
  }
  if (light.range) share *= std::max(1 - std::pow(r / *light.range, 4), 0.0);
  return share;
}

/// ∫ along a view ray without end: in equal steps of the angle at the light, where 1/r² has gone, between the
/// ends of the one part that the light reaches, which are found by steps and then by halving.
glm::dvec3 airlight(const scene::View& view, glm::dvec3 ray) {
  constexpr int k_steps = 2000;
  const scene::Light& light = view.lights[0];
  const glm::dvec3 to_light = light.position - view.camera.eye;
  const double nearest = glm::dot(to_light, ray), across = glm::length(to_light - nearest * ray);
  const auto share_at = [&](double angle) {
    const glm::dvec3 direction =
        (across * std::tan(angle) * ray + nearest * ray - to_light) * std::cos(angle) / across;
    return share(light, direction, across / std::cos(angle));
  };
  const double eye = std::atan2(-nearest, across), step = (0.5 * std::numbers::pi - eye) / k_steps;
  int first = -1, last = -1;
  for (int i = 0; i < k_steps; ++i) {
    if (share_at(eye + (i + 0.5) * step) <= 0.0) continue;
    if (first < 0) first = i;
    last = i;
  }
  if (first < 0) return glm::dvec3(0.0);
  const auto end = [&](double lit, double dark) {
    for (int i = 0; i < 40; ++i) (share_at(0.5 * (lit + dark)) > 0.0 ? lit : dark) = 0.5 * (lit + dark);
    return lit;
  };
  const double from = first == 0 ? eye : end(eye + (first + 0.5) * step, eye + (first - 0.5) * step);
  const double to = last == k_steps - 1 ? 0.5 * std::numbers::pi
                                        : end(eye + (last + 0.5) * step, eye + (last + 1.5) * step);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < k_steps; ++i) {
    const double angle = from + (to - from) * (i + 0.5) / k_steps;
    const double path = nearest + across * std::tan(angle) + across / std::cos(angle);
    const double phase = reference::phase(view.medium, -std::sin(angle));
    for (int channel = 0; channel < 3; ++channel) {
      const double sigma_s = static_cast<double>(view.medium.sigma_s[channel]);
      const double sigma_t = sigma_s + static_cast<double>(view.medium.sigma_a[channel]);
      sum[channel] += sigma_s * std::exp(-sigma_t * path) * phase * share_at(angle);
    }
  }
  return glm::dvec3(light.intensity) * sum * ((to - from) / k_steps / across);
}

struct Case {
  const char* name;
  glm::dvec3 light, axis;
  double inner, outer;  ///< [degrees]; none where 0
  double range = 0.0;   ///< [m]; none where 0
};
void PrintTo(const Case& c, std::ostream* stream) {
  *stream << c.name;
}

constexpr glm::dvec3 k_ahead{0.7, 0.9, -4}, k_behind{0.4, 1.5, 3};
constexpr Case k_cases[] = {
    {"HalfSpace", k_ahead, {0.2, -1, 0.3}, 90, 90},
    {"HalfSpaceTowardsTheEye", k_ahead, {0.1, -0.2, 1}, 90, 90},
    {"StepFromAbove", k_ahead, {0.1, -1, 0.2}, 35, 35},
    {"StepAcross", k_ahead, {-1, 0.2, 0.1}, 10, 10},
    {"StepTowardsTheEye", k_ahead, {-0.1, -0.3, 1}, 30, 30},
    {"StepAwayFromTheEye", k_ahead, {0.1, -0.2, -1}, 40, 40},
    {"StepFromBehind", k_behind, {0, -0.4, -1}, 30, 30},
    {"RampFromAbove", k_ahead, {0.1, -1, 0.2}, 10, 35},
    {"RampFromNothing", k_ahead, {-0.4, -1, 0.2}, 0, 60},
    {"RampToHalfSpace", k_ahead, {-0.4, -1, 0.2}, 80, 90},
    {"RampTowardsTheEye", k_ahead, {-0.1, -0.1, 1}, 20, 40},
    {"RampFromBehind", k_behind, {0, -0.4, -1}, 15, 45},
    {"Narrow", k_ahead, {-0.3, -0.9, 0.2}, 0.5, 1},
    {"Range", k_ahead, {0, 1, 0}, 0, 0, 3},
    {"RangeBeyondTheEye", k_ahead, {0, 1, 0}, 0, 0, 6},
    {"RangeFromBehind", k_behind, {0, 1, 0}, 0, 0, 5},
    {"RampAndRange", k_ahead, {0.1, -1, 0.2}, 20, 50, 2.5},
};

scene::View view_of(const Case& c) {
  scene::View view;
  view.camera.vertical_fov_degrees = 70;  // from the origin, along −Z
  view.size = {24, 24};
  view.medium = {.sigma_s = {0.1f, 0.3f, 0.05f}, .sigma_a = {0.0f, 0.1f, 0.6f}};
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = 0.6f;
  scene::Light& light = view.lights[0];
  light = scene::point_light("", c.light, {3, 2, 1});
  if (c.outer > 0.0) light.cone = scene::Cone{glm::normalize(c.axis), c.inner * k_degree, c.outer * k_degree};
  if (c.range > 0.0) light.range = c.range;
  return view;
}

class LightOf : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cases, LightOf, testing::ValuesIn(k_cases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(LightOf, FillsEmptyFogAsItsSumDoes) {
  const scene::View view = view_of(GetParam());
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  std::vector<glm::vec3> expected;
  const int pixels = view.size.x * view.size.y;
  for (int i = 0; i < pixels; ++i)
    expected.emplace_back(airlight(view, tests::pixel_ray(camera, view.size, static_cast<std::size_t>(i))));
  const auto by = [&](VsvIntegral integral) {
    return tests::error_of(tests::render_vsv({}, view, {.integral = integral}).airlight, expected);
  };
  const auto quadrature = by(VsvIntegral::quadrature);
  // Of a cone 1° wide, what 1e-7 is at its edges, in single precision.
  EXPECT_LT(quadrature.rrmse, 2e-4);
  EXPECT_LT(std::abs(quadrature.bias), 5e-5);
  RecordProperty("quadrature", std::to_string(quadrature.rrmse));
  // Cells count as their centres say.
  const auto riemann = by(VsvIntegral::riemann);
  EXPECT_LT(std::abs(riemann.bias), 0.02);
  RecordProperty("riemann", std::to_string(riemann.rrmse));
}

/// By quadrature a texture's light and a spot's edge meet in a product.
TEST(TexturedSpot, IsASumOfItsSamples) {
  std::vector<glm::vec3> texels;
  for (int i = 0; i < 16 * 8; ++i) texels.emplace_back(1.0f + 0.9f * std::sin(0.7f * static_cast<float>(i)));
  for (const Case& c : k_cases) {
    if (std::string(c.name).find("Ramp") != 0) continue;
    scene::View view = view_of(c);
    view.lights[0].texture = std::make_shared<scene::LightTexture>("waves", glm::ivec2(16, 8), texels);
    const auto by = [&](VsvIntegral integral) {
      return tests::render_vsv({}, view, {.resolution = {256, 1024, 2048}, .integral = integral}).airlight;
    };
    const auto error = tests::error_of(by(VsvIntegral::quadrature), by(VsvIntegral::riemann));
    EXPECT_LT(error.rrmse, 2e-3) << c.name;
    EXPECT_LT(std::abs(error.bias), 1e-3) << c.name;
    RecordProperty(c.name, std::to_string(error.rrmse));
  }
}

TEST_P(LightOf, IsRefusedByIntegralsThatLookUpATableOfAlphaAndPhi) {
  const scene::View view = view_of(GetParam());
  for (const VsvIntegral integral : {VsvIntegral::table, VsvIntegral::factored})
    EXPECT_TRUE(media::VsvOptions{.integral = integral}.refusal(view));
  EXPECT_EQ(media::VsvOptions{}.used_integral(view), VsvIntegral::quadrature);
}

}  // namespace
}  // namespace airlight
