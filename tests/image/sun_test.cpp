#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/view_rays.h"

/// The sun, in endless fog and in a layer.
namespace airlight {
namespace {

using media::VsvIntegral;
using std::numbers::pi;

constexpr VsvIntegral k_integrals[] = {VsvIntegral::table, VsvIntegral::riemann, VsvIntegral::factored};

scene::View sun_view(glm::dvec3 towards, glm::dvec3 looking, double eye_y, std::optional<double> top) {
  scene::View view;
  view.camera.eye = {0.4, eye_y, 2.0};
  view.camera.target = view.camera.eye + looking;
  if (std::abs(glm::normalize(looking).y) > 0.99) view.camera.up = {0, 0, 1};
  view.camera.vertical_fov_degrees = 60;
  view.lights[0] = scene::sun("", towards, {10, 6, 3});
  view.medium = {.sigma_s = {0.2f, 0.1f, 0.4f}, .sigma_a = {0.0f, 0.2f, 0.1f}, .top = top};
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = 0.5f;
  view.size = {33, 33};
  return view;
}

/// The airlight of a view ray without occluders, by the definition: the sum over short lengths of it of what
/// scatters there, dimmed by what of the light's way to there and of the way to the eye is in the fog.
glm::dvec3 by_definition(const scene::View& view, const glm::dvec3& ray) {
  const scene::Light& sun = view.lights[0];
  const scene::Medium& medium = view.medium;
  const double cosine = glm::dot(ray, sun.towards), g = static_cast<double>(medium.g);
  const double phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  const glm::dvec3 sigma_t = glm::dvec3(medium.sigma_s + medium.sigma_a);
  double entry = 0, exit = 60 / sigma_t.g;
  const double top = medium.top.value_or(0) - view.camera.eye.y;
  if (medium.top) {
    if (top < 0 && ray.y >= 0) return glm::dvec3(0);
    if (top < 0) entry = top / ray.y;
    if (top >= 0 && ray.y > 0) exit = std::min(exit, top / ray.y);
    exit += entry;
  }
  // Simpson's rule, in steps that grow.
  glm::dvec3 sum(0);
  constexpr int k_steps = 4000;
  const auto at = [&](double s) {
    const double t = entry + (exit - entry) * s * s * s;
    const double light = medium.top ? (top - t * ray.y) / sun.towards.y : 0;
    return glm::exp(-sigma_t * (t - entry + light)) * (3 * s * s * (exit - entry));
  };
  for (int i = 0; i < k_steps; ++i) {
    const double from = static_cast<double>(i) / k_steps, to = static_cast<double>(i + 1) / k_steps;
    sum += (at(from) + 4.0 * at(0.5 * (from + to)) + at(to)) * ((to - from) / 6);
  }
  return glm::dvec3(medium.sigma_s) * glm::dvec3(sun.irradiance) * phase * sum;
}

/// @param tolerance relative; single precision takes 1e-5 of a path's depth
void expect_empty(const scene::View& view, VsvIntegral integral, double tolerance = 3e-5) {
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const auto image = tests::render_vsv({}, view, {.integral = integral}).airlight;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const glm::dvec3 ray = tests::pixel_ray(camera, view.size, i);
    // Nearer to the sun than a quarter of a pixel a ray is moved.
    if (std::abs(glm::dot(ray, view.lights[0].towards)) > 1 - 1e-4) continue;
    const glm::dvec3 expected = by_definition(view, ray);
    for (int channel = 0; channel < 3; ++channel)
      ASSERT_NEAR(static_cast<double>(image[i][channel]), expected[channel],
                  tolerance * expected[channel] + 1e-9)
          << "pixel " << i << ", channel " << channel;
  }
}

struct SunCase {
  const char* name;
  glm::dvec3 towards, looking;
  double eye_y;
  std::optional<double> top;
};
void PrintTo(const SunCase& sun, std::ostream* stream) {
  *stream << sun.name;
}

class EmptyFog : public testing::TestWithParam<SunCase> {};

TEST_P(EmptyFog, IsRightByEveryIntegral) {
  const SunCase& sun = GetParam();
  for (const VsvIntegral integral : k_integrals)
    expect_empty(sun_view(sun.towards, sun.looking, sun.eye_y, sun.top), integral);
}

const SunCase k_cases[] = {
    {"Zenith", {0, 1, 0}, {0, 0, -1}, -1.0, 0.5},
    {"Slanting", {0.5, 1, -0.3}, {0, 0.1, -1}, -1.0, 0.5},
    {"Low", {0.2, 0.05, 1}, {1, 0.02, 0.1}, -1.0, 0.5},
    {"Into", {0.1, 0.3, -1}, {0.1, 0.3, -1}, -1.0, 0.5},
    {"Away", {0.1, 0.3, 1}, {-0.1, -0.3, -1}, -1.0, 0.5},
    {"Across", {1, 0.4, 0}, {0, 0, -1}, -1.0, 0.5},
    {"FromAbove", {0.5, 1, -0.3}, {0, -0.5, -1}, 2.0, 0.5},
    {"FromAboveDown", {0.5, 1, -0.3}, {0, -1, 0}, 2.0, 0.5},
    {"AtTheTop", {0.5, 1, -0.3}, {0, -0.2, -1}, 0.5, 0.5},
    {"Endless", {0.5, 1, -0.3}, {0, 0.1, -1}, 0.0, {}},
    {"EndlessInto", {0.5, 0.2, -1}, {0.5, 0.2, -1}, 0.0, {}},
    {"EndlessFromBelow", {0.5, -0.6, -1}, {0.1, 0.1, -1}, 0.0, {}},
};
INSTANTIATE_TEST_SUITE_P(Suns, EmptyFog, testing::ValuesIn(k_cases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Sun, HasNoGapWhereThePathStandsStill) {
  // Where a view ray rises as the sun does its path is alike from everywhere; the row of pixels is moved past
  // it.
  for (const double off : {0.0, 1e-6, -1e-6, 1e-4, -1e-4, 1e-2}) {
    scene::View view = sun_view({0.8, 0.6, 0.0}, {0, 0.6 + off, -0.8}, -1.0, 0.5);
    view.size = {3, 1};
    expect_empty(view, VsvIntegral::table);
  }
}

/// Slats between the eye and the sun, some of them above the fog.
scene::Geometry slats() {
  scene::Geometry geometry;
  const auto add_quad = [&](glm::vec3 at, glm::vec3 u, glm::vec3 v) {
    const auto first = static_cast<std::uint32_t>(geometry.positions.size());
    for (const glm::vec3& corner : {at, at + u, at + u + v, at + v}) geometry.positions.push_back(corner);
    geometry.triangles.push_back({first, first + 1, first + 2});
    geometry.triangles.push_back({first, first + 2, first + 3});
  };
  for (int i = 0; i < 5; ++i)
    add_quad({-2.0f + static_cast<float>(i), 0.2f, -3.0f}, {0.4f, 0, 0}, {0, 1.5f, 0});
  add_quad({-1.5f, 2.0f, -2.0f}, {2, 0, 0}, {0, 0, 1});
  add_quad({-20, -1.5f, -20}, {40, 0, 0}, {0, 0, 40});
  geometry.materials = {{}};
  geometry.material_of_triangle.assign(geometry.triangles.size(), 0);
  return geometry;
}

TEST(Sun, AmongSlatsIsTheReference) {
  const scene::Geometry geometry = slats();
  for (const SunCase& sun :
       {SunCase{"", {0.3, 0.6, -1}, {0, 0, -1}, 0, 1.0}, SunCase{"", {0.1, 0.15, -1}, {0, 0.1, -1}, 0, {}},
        SunCase{"", {0.3, 0.9, 1}, {0, -0.1, -1}, 0.3, 3.0},
        SunCase{"", {0.3, 0.6, -1}, {0, -0.3, -1}, 2, 1.0}}) {
    scene::View view = sun_view(sun.towards, sun.looking, sun.eye_y, sun.top);
    view.size = {64, 64};
    const tests::Truth truth = tests::trace(geometry, view);
    for (const VsvIntegral integral : {VsvIntegral::table, VsvIntegral::riemann}) {
      const auto error = tests::error_of(
          tests::render_vsv(geometry, view, {.integral = integral, .shadow_map = 4096}), truth);
      EXPECT_LT(error.rrmse, 0.01);  // edges of shadow lie between cells
      EXPECT_NEAR(error.bias, 0.0, 0.002);
    }
  }
}

TEST(Sun, ShadowsNothingByRangesThatHalfPlanesShare) {
  const scene::Geometry geometry = slats();
  scene::View view = sun_view({0.3, 0.6, -1}, {0, 0, -1}, 0, 1.0);
  view.size = {64, 64};
  const tests::Truth truth = tests::trace(geometry, view);
  for (const epipolar::Ranges ranges : {epipolar::Ranges::alpha_phi, epipolar::Ranges::full})
    EXPECT_LT(tests::error_of(tests::render_vsv(geometry, view, {.ranges = ranges}), truth).rrmse, 0.02);
}

TEST(Sun, IsWhatAFarLampGoesOverInto) {
  // Irradiance E from D away is I = E D². In a layer, which leaves most of the lamp's way free of fog.
  const scene::Geometry geometry = slats();
  scene::View view = sun_view({0.3, 0.6, -1}, {0, 0, -1}, 0, 1.0);
  view.size = {48, 48};
  const tests::VsvSettings riemann{.integral = VsvIntegral::riemann, .shadow_map = 4096};
  const frame::FrameImages by_sun = tests::render_vsv(geometry, view, riemann);
  const double error_by_sun = tests::error_of(by_sun, tests::trace(geometry, view)).rrmse;
  const scene::Light sun = view.lights[0];
  constexpr double k_scene_size = 40;
  for (const double sizes : {10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    const double distance = sizes * k_scene_size;
    view.lights[0] = scene::point_light("", view.camera.eye + distance * sun.towards,
                                        sun.irradiance * static_cast<float>(distance * distance));
    const frame::FrameImages by_lamp = tests::render_vsv(geometry, view, riemann);
    // Light rays a scene away from the axis are so many radians off the sun's. Cells and texels go over into
    // the sun's too.
    EXPECT_LT(tests::error_of(by_lamp.airlight, by_sun.airlight).rrmse, 3 / sizes + 0.001) << sizes;
    EXPECT_LT(tests::error_of(by_lamp, tests::trace(geometry, view)).rrmse, 1.5 * error_by_sun) << sizes;
  }
}

}  // namespace
}  // namespace airlight
