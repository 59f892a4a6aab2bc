#include <cmath>
#include <functional>
#include <optional>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"
#include "scene/import.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/shared.h"

/// A table of awkward views and what comes of them: an image without NaN that agrees with the reference, or
/// the documented error.
namespace airlight {
namespace {

using scene::ExitCode;

/// A floor and three blocks around the origin; the middle one is x, z ∈ [−0.5, 0.5], y ∈ [0, 2].
scene::Geometry blocks() {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  tests::add_box(geometry, {-0.5f, 0, -0.5f}, {0.5f, 2, 0.5f});
  tests::add_box(geometry, {-2.5f, 0, -1.5f}, {-1.7f, 1.4f, -0.2f});
  tests::add_box(geometry, {1.5f, 0, -2}, {1.9f, 3, 0.4f});
  return geometry;
}

struct Case {
  std::string name;
  std::function<void(scene::View&, scene::Geometry&)> change;  ///< of the blocks, lit from above at the left
  /// Largest error of the mean airlight, relative to the reference's or, where the reference is dark, to the
  /// mean without geometry. Left out where an error is expected.
  double tolerance = 0.0;
  std::optional<ExitCode> error = {};
};

void PrintTo(const Case& c, std::ostream* stream) {
  *stream << c.name;
}

scene::View blocks_view() {
  scene::View view;
  view.camera.eye = {0.3, 1.5, 6.0};
  view.camera.target = {0.0, 1.0, 0.0};
  view.camera.vertical_fov_degrees = 50;
  view.lights[0].position = {-3.0, 3.5, 1.0};
  view.lights[0].intensity = glm::vec3(10.0f);
  view.medium.sigma_s = glm::vec3(0.1f);
  view.size = {49, 49};  // an odd number: a pixel centre lies in the middle
  return view;
}

/// Puts the light at this distance in the direction of a point of the image, in [−1, 1]².
void light_at(scene::View& view, double x, double y, double distance) {
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  view.lights[0].position =
      view.camera.eye + distance * glm::normalize(camera.forward + x * camera.half_width * camera.right +
                                                  y * camera.half_height * camera.up);
}

double mean(const std::vector<glm::vec3>& image) {
  double sum = 0.0;
  for (const glm::vec3& value : image) sum += static_cast<double>(value.x + value.y + value.z) / 3;
  return sum / static_cast<double>(image.size());
}

std::vector<Case> cases() {
  // What 256 × 512 × 256 cells and a shadow map of 512² texels leave of the mean.
  const double usual = 0.005;
  const auto light = [](double x, double y, double z) {
    return [=](scene::View& view, scene::Geometry&) { view.lights[0].position = {x, y, z}; };
  };
  const auto at = [](double x, double y, double distance) {
    return [=](scene::View& view, scene::Geometry&) { light_at(view, x, y, distance); };
  };
  const auto size = [](int width, int height) {
    return [=](scene::View& view, scene::Geometry&) { view.size = {width, height}; };
  };
  const auto sigma = [](float sigma_s) {
    return [=](scene::View& view, scene::Geometry&) { view.medium.sigma_s = glm::vec3(sigma_s); };
  };
  return {
      {"plain", [](scene::View&, scene::Geometry&) {}, usual},
      {"light_behind_the_camera", light(0.8, 2.5, 9), usual},
      {"light_on_a_face", light(0.1, 2, 0.2), usual},
      {"light_on_the_floor", light(-1.1, 0, 1.3), usual},
      {"light_on_a_vertex", light(0.5, 2, 0.5), usual},
      {"light_inside_an_object", light(0.1, 1, 0.2), usual},
      {"light_under_the_floor", light(0.3, -0.5, 0.5), usual},
      {"light_outside_the_scene", light(30, 40, -20), usual},
      {"light_a_million_metres_away",
       [](scene::View& view, scene::Geometry&) {
         view.lights[0].position = {4e5, 8e5, -3e5};
         view.lights[0].intensity = glm::vec3(1e12f);
         view.medium.sigma_s = glm::vec3(1e-7f);
       },
       usual},
      {"light_a_millimetre_from_the_eye", light(0.3, 1.5005, 6.0008), usual},
      {"light_at_the_eye", light(0.3, 1.5, 6.0), 0, ExitCode::bad_file},
      {"light_is_nan", light(std::nan(""), 0, 0), 0, ExitCode::bad_file},
      {"into_the_light_at_a_pixel_centre", at(0, 0, 3), usual},
      {"into_the_light_between_pixels", at(1.0 / 49, 1.0 / 49, 3), usual},
      {"into_the_light_behind_a_block", at(0, 0, 9), usual},
      {"straight_away_from_the_light", at(0, 0, -2), usual},
      {"straight_away_into_the_sky",
       [](scene::View& view, scene::Geometry&) {
         view.camera.target = view.camera.eye + glm::dvec3(0, 1, 1);
         light_at(view, 0, 0, -1.5);
       },
       usual},
      {"epipole_on_the_right_edge", at(1, 0.1, 3), usual},
      {"epipole_on_the_upper_edge", at(0.3, 1, 3), usual},
      {"epipole_on_a_corner", at(-1, 1, 3), usual},
      {"far_epipole_on_the_left_edge", at(1, 0.1, -3), usual},
      {"far_epipole_on_a_corner", at(1, 1, -3), usual},
      {"light_straight_below_the_eye", light(0.3, 0.4, 6.0), usual},
      {"light_straight_above_the_eye", light(0.3, 2.9, 6.0), usual},
      {"camera_straight_down_into_the_light_below",
       [](scene::View& view, scene::Geometry&) {
         view.camera.eye = {3.5, 5, 1};
         view.camera.target = {3.5, 0, 1};
         view.camera.up = {0, 0, -1};
         view.lights[0].position = {3.5, 1, 1};
       },
       usual},
      {"camera_inside_an_object",
       [](scene::View& view, scene::Geometry&) {
         view.camera.eye = {0.1, 1.1, 0.2};
       },
       usual},
      {"camera_on_a_face_that_it_looks_away_from",
       [](scene::View& view, scene::Geometry&) {
         view.camera.eye = {0.1, 1.1, 0.5};
         view.camera.target = {-1, 1, 3};
       },
       usual},
      // The face lies at distance 0: one may see it, and no airlight, or look through it.
      {"camera_on_a_face_that_it_looks_at",
       [](scene::View& view, scene::Geometry&) {
         view.camera.eye = {0.1, 1.1, 0.5};
       },
       1.0},
      {"empty_mesh", [](scene::View&, scene::Geometry& geometry) { geometry = {}; }, 1e-3},
      {"one_pixel", size(1, 1), 0.05},
      {"one_pixel_wide", size(1, 61), 0.02},
      {"one_pixel_high", size(61, 1), 0.02},
      {"wider_than_work_groups", size(131, 9), usual},
      {"no_fog", sigma(0.0f), usual},
      {"only_absorption",
       [](scene::View& view, scene::Geometry&) {
         view.medium.sigma_s = glm::vec3(0.0f);
         view.medium.sigma_a = glm::vec3(0.3f);
       },
       usual},
      {"thin_fog", sigma(1e-6f), usual},
      {"dense_fog", sigma(3.0f), usual},
      {"fog_like_a_wall", sigma(1e6f), usual},
      {"sharp_forward_lobe",
       [](scene::View& view, scene::Geometry&) {
         view.medium.phase = scene::PhaseFunction::henyey_greenstein;
         view.medium.g = 0.95f;
       },
       usual},
      {"sharp_backward_lobe",
       [](scene::View& view, scene::Geometry&) {
         view.medium.phase = scene::PhaseFunction::henyey_greenstein;
         view.medium.g = -0.95f;
       },
       usual},
      {"g_of_one",
       [](scene::View& view, scene::Geometry&) {
         view.medium.phase = scene::PhaseFunction::henyey_greenstein;
         view.medium.g = 1.0f;
       },
       0, ExitCode::bad_file},
      {"no_light", [](scene::View& view, scene::Geometry&) { view.lights[0].intensity = glm::vec3(0.0f); },
       usual},
      {"narrow_view", [](scene::View& view, scene::Geometry&) { view.camera.vertical_fov_degrees = 0.05; },
       0.02},
      {"wide_view", [](scene::View& view, scene::Geometry&) { view.camera.vertical_fov_degrees = 170; },
       usual},
      {"no_pixels", size(0, 5), 0, ExitCode::usage},
      {"far_from_the_origin",
       [](scene::View& view, scene::Geometry& geometry) {
         const glm::dvec3 offset(1 << 18, -(1 << 17), 1 << 19);  // the blocks are exact to 1/32 m there
         for (glm::vec3& position : geometry.positions) position += glm::vec3(offset);
         view.camera.eye += offset;
         view.camera.target += offset;
         view.lights[0].position += offset;
       },
       usual},
  };
}

class Robustness : public testing::TestWithParam<Case> {};

/// Renders surfaces and airlight, and compares the mean airlight with the reference's.
void expect_sane(const scene::Geometry& geometry, const scene::View& view, double tolerance) {
  const tests::VsvSettings settings{
      .resolution = {256, 512, 256}, .shadow_map = 512, .surface_shadows = true};
  const frame::FrameImages images = tests::render_vsv(geometry, view, settings);  // refuses NaN and infinity
  for (const glm::vec3& value : images.radiance)
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(value, glm::vec3(0.0f))));
  for (const glm::vec3& value : images.airlight)
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(value, glm::vec3(0.0f))));

  const double expected = mean(reference::Reference(geometry, view).converged(256).radiance);
  const double unshadowed = mean(reference::Reference({}, view).converged(16).radiance);
  const double scale = expected > 0.01 * unshadowed ? expected : unshadowed;
  const double difference = mean(images.airlight) - expected;
  testing::Test::RecordProperty("error", std::to_string(scale > 0 ? difference / scale : difference));
  // 1e-20: the exponent of extinction ends at e⁻⁸⁰.
  EXPECT_LE(std::abs(difference), tolerance * scale + 1e-20)
      << mean(images.airlight) << " against " << expected << ", " << unshadowed << " without geometry";
}

TEST_P(Robustness, GivesASaneImageOrTheDocumentedError) {
  const Case& c = GetParam();
  scene::View view = blocks_view();
  scene::Geometry geometry = blocks();
  c.change(view, geometry);
  if (!c.error) return expect_sane(geometry, view, c.tolerance);
  try {
    tests::render_vsv(geometry, view, {.resolution = {64, 64, 128}, .shadow_map = 64});
    FAIL() << "an error was expected";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, *c.error) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Robustness, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

TEST(RobustnessOfFiles, AMeshFarFromTheOriginIsSane) {
  const std::filesystem::path file = tests::shared_file("scenes/nonmanifold_1k.glb");
  AIRLIGHT_NEEDS(file);
  const scene::Scene scene = scene::import_scene(file);
  const scene::Box box = scene::bounds(scene.geometry);
  const glm::dvec3 size(box.upper - box.lower);
  scene::View view;
  view.camera = scene::fit_camera(scene.geometry);
  view.lights[0].position = glm::dvec3(box.upper) + 0.3 * size;
  const double extent = glm::length(size);
  view.lights[0].intensity = glm::vec3(static_cast<float>(extent * extent));
  view.medium.sigma_s = glm::vec3(static_cast<float>(0.3 / extent));
  view.size = {64, 64};
  expect_sane(scene.geometry, view, 0.01);
}

TEST(RobustnessOfFiles, OneThatOverflowsIsRefused) {
  const std::filesystem::path file = tests::shared_file("scenes/float_overflow_12.obj");
  AIRLIGHT_NEEDS(file);
  try {
    scene::import_scene(file);
    FAIL() << "an error was expected";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, ExitCode::bad_file);
    EXPECT_THAT(error.what(), testing::HasSubstr("float_overflow_12.obj"));
  }
}

}  // namespace
}  // namespace airlight
