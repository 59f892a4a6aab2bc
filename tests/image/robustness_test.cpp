#include <cmath>
#include <functional>
#include <numbers>
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
#include "support/view_rays.h"

/// A table of awkward views and what comes of them: an image without NaN that agrees with the reference, or
/// the documented error.
namespace airlight {
namespace {

using scene::ExitCode;

/// A floor and three blocks around the origin, each closed; the middle one is x, z ∈ [−0.5, 0.5], y ∈ [0, 2].
scene::Geometry blocks() {
  scene::Geometry geometry;
  tests::add_box(geometry, {-8, -0.25f, -8}, {8, 0, 8});
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
  bool light_touches_solid = false;  ///< or is inside of one
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
  view.lights[0].position = view.camera.eye + distance * tests::view_ray(camera, x, y);
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
      {"light_on_a_face", light(0.1, 2, 0.2), usual, {}, true},
      {"light_in_the_middle_of_a_face",
       [](scene::View& view, scene::Geometry& geometry) {
         geometry = {};
         tests::add_box(geometry, {0.2f, 1.8f, -3.0f}, {0.4f, 2.0f, -2.9f});
         // That face either way round: it depends on it what a driver draws of a triangle through the light.
         tests::add_quad(geometry, {0.2f, 1.8f, -3.0f}, {0, 0.2f, 0}, {0.2f, 0, 0});
         tests::add_quad(geometry, {-5, -2, -5}, {10, 0, 0}, {0, 8, 0});
         view.camera.eye = {0, 1.5, 4};
         view.camera.target = {0, 1.5, 0};
         view.lights[0].position = {0.3, 1.9, -3};
       },
       usual,
       {},
       true},
      {"light_on_the_floor", light(-1.1, 0, 1.3), usual, {}, true},
      {"light_on_a_vertex", light(0.5, 2, 0.5), usual, {}, true},
      {"light_on_an_edge", light(0.5, 1.2, 0.5), usual, {}, true},
      {"light_inside_an_object", light(0.1, 1, 0.2), usual, {}, true},
      {"light_under_the_floor", light(0.3, -0.5, 0.5), usual, {}, true},
      // Of the light that a near plane of 1e-4 of its distance lets past the wall, 4 % of the mean came.
      {"light_close_behind_a_far_wall",
       [](scene::View& view, scene::Geometry& geometry) {
         geometry = {};
         tests::add_quad(geometry, {-5, -1, -5}, {10, 0, 0}, {0, 5, 0});
         view.camera.eye = {0, 1.5, 995};
         view.camera.target = {0, 1.5, 0};
         view.camera.vertical_fov_degrees = 0.4584;
         view.lights[0].position = {0.3, 1.5, -5.02};
       },
       usual,
       {},
       true},
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

void expect_not_negative(const frame::FrameImages& images) {
  for (const auto* image : {&images.radiance, &images.airlight})
    for (const glm::vec3& value : *image)
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(value, glm::vec3(0.0f))));
}

/// A view's truth, and what errors are measured by.
struct Expected {
  Expected(const scene::Geometry& geometry, const scene::View& view)
      : truth(tests::trace(geometry, view)), mean_airlight(mean(truth.airlight.radiance)) {
    const double unshadowed = mean(reference::Reference({}, view).exact().radiance);
    scale = mean_airlight > 0.01 * unshadowed ? mean_airlight : unshadowed;
  }

  /// Of the mean, relative.
  double error(const frame::FrameImages& images) const {
    const double difference = mean(images.airlight) - mean_airlight;
    // The exponent of extinction ends at e⁻⁸⁰.
    return std::abs(difference) <= 1e-20 ? 0.0 : difference / scale;
  }

  /// By how much a pixel is too bright at the most, relative to the mean.
  double largest_excess(const frame::FrameImages& images) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < images.airlight.size(); ++i) {
      if (std::abs(images.distance[i] - truth.surfaces.distance[i]) > 1e-3f * truth.surfaces.distance[i])
        continue;  // a pixel that sees past the edge of a surface
      const glm::vec3 more = images.airlight[i] - truth.airlight.radiance[i];
      largest = std::max(largest, static_cast<double>(std::max({more.x, more.y, more.z})));
    }
    return largest <= 1e-20 ? 0.0 : largest / scale;
  }

  tests::Truth truth;
  double mean_airlight, scale;
};

tests::VsvSettings settings() {
  return {.resolution = {256, 512, 256}, .shadow_map = 512, .surface_shadows = true};
}

/// A way to make the grid, and what it may add to a case's error of the mean.
struct Choice {
  const char* name;
  void (*change)(tests::VsvSettings&);
  double darker = 0.0;
  bool needs_light_apart = false;  ///< from solids
};

const Choice k_choices[] = {
    {"default", [](tests::VsvSettings&) {}},
    // Every voxel that a triangle touches is dark: up to a cell beyond each of its edges, along all three
    // angles.
    {"populate=conservative", [](tests::VsvSettings& s) { s.populate = epipolar::Populate::conservative; },
     0.012},
    {"populate=screen-space", [](tests::VsvSettings& s) { s.populate = epipolar::Populate::screen_space; },
     0.0, true},
    {"ranges=alpha-phi", [](tests::VsvSettings& s) { s.ranges = epipolar::Ranges::alpha_phi; }},
    {"ranges=full", [](tests::VsvSettings& s) { s.ranges = epipolar::Ranges::full; }},
    {"phi-cells=equal", [](tests::VsvSettings& s) { s.phi_cells = media::PhiCells::equal; }},
    {"theta-cells=equal", [](tests::VsvSettings& s) { s.theta_cells = epipolar::ThetaCells::equal; }},
};

void expect_sane(const scene::Geometry& geometry, const scene::View& view, double tolerance,
                 bool light_touches_solid) {
  const Expected expected(geometry, view);
  frame::FrameImages by_default;
  for (const Choice& choice : k_choices) {
    if (choice.needs_light_apart && light_touches_solid) continue;
    tests::VsvSettings changed = settings();
    choice.change(changed);
    const frame::FrameImages images = tests::render_vsv(geometry, view, changed);  // refuses NaN and infinity
    expect_not_negative(images);
    const double error = expected.error(images);
    testing::Test::RecordProperty(choice.name, std::to_string(error));
    EXPECT_LE(error, tolerance) << choice.name;
    EXPECT_GE(error, -(tolerance + choice.darker)) << choice.name;
    // No light leaks: what is left is the table's interpolation, most of all in a sharp lobe.
    if (changed.populate == epipolar::Populate::conservative) {
      EXPECT_LE(expected.largest_excess(images), 0.05);
    }
    if (&choice == &k_choices[0]) by_default = images;
  }
  for (const epipolar::Scan scan : {epipolar::Scan::column, epipolar::Scan::multi_pass}) {
    tests::VsvSettings changed = settings();
    changed.scan = scan;
    EXPECT_EQ(tests::render_vsv(geometry, view, changed).airlight, by_default.airlight)
        << "the same bits by another scan";
  }
}

TEST_P(Robustness, GivesASaneImageOrTheDocumentedError) {
  const Case& c = GetParam();
  scene::View view = blocks_view();
  scene::Geometry geometry = blocks();
  c.change(view, geometry);
  if (c.error) {
    try {
      tests::render_vsv(geometry, view, {.resolution = {64, 64, 128}, .shadow_map = 64});
      FAIL() << "an error was expected";
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.exit_code, *c.error) << error.what();
    }
    return;
  }
  expect_sane(geometry, view, c.tolerance, c.light_touches_solid);
}

INSTANTIATE_TEST_SUITE_P(Cases, Robustness, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

/// The wall makes voxels dark that at a grazing angle lie far before it.
TEST(RobustnessInAPipe, ItsWallDarkensNothingBeforeIt) {
  scene::Geometry pipe;
  constexpr int k_sides = 64;
  const auto side = [](int i) {
    const double angle = 2.0 * std::numbers::pi * i / k_sides;
    return glm::vec3(0.05 * std::cos(angle), 0.05 * std::sin(angle), -10.0);
  };
  for (int i = 0; i < k_sides; ++i) tests::add_quad(pipe, side(i), side(i + 1) - side(i), {0, 0, 20});
  scene::View view;
  view.camera.eye = {0, 0, 4};
  view.camera.target = {0, 0, 0};
  view.camera.vertical_fov_degrees = 45;
  view.lights[0].position = {0.01, 0.01, -3};
  view.medium.sigma_s = glm::vec3(0.1f);
  view.size = {64, 64};
  const tests::Truth truth = tests::trace(pipe, view);
  for (const epipolar::Populate populate :
       {epipolar::Populate::shadow_map, epipolar::Populate::conservative}) {
    tests::VsvSettings changed = settings();
    changed.populate = populate;
    changed.resolution.alpha *= 2;  // cells are twice as wide, far from the axis, as equal ones would be
    changed.shadow_map = 2048;  // fewer texels place the wall too coarsely
    EXPECT_LE(tests::error_of(tests::render_vsv(pipe, view, changed), truth).rrmse, 0.02);
  }
}

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
  expect_sane(scene.geometry, view, 0.01, true);  // it bounds no solid
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
