#include "epipolar/space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "support/grid_bits.h"
#include "support/random.h"
#include "support/view_rays.h"

namespace airlight::epipolar {
namespace {

using std::numbers::pi;
using tests::Random;

double angle_between(glm::dvec3 a, glm::dvec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void expect_orthonormal(glm::dvec3 l) {
  const Axes axes = make_axes(l);
  const auto near = [&](double value, double expected) {
    EXPECT_NEAR(value, expected, 1e-10) << l.x << " " << l.y << " " << l.z;
  };
  near(glm::length(axes.u), 1);
  near(glm::length(axes.f), 1);
  near(glm::dot(axes.axis, axes.u), 0);
  near(glm::dot(axes.axis, axes.f), 0);
  near(glm::dot(axes.u, axes.f), 0);
  const glm::dvec3 difference = glm::cross(axes.u, axes.f) - axes.axis;
  near(glm::length(difference), 0);
}

TEST(MakeAxes, AreOrthonormalAndRightHanded) {
  Random random(1);
  for (int i = 0; i < 50000; ++i) expect_orthonormal(random.direction());
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) {
      glm::dvec3 l(0.0);
      l[axis] = sign;
      expect_orthonormal(l);
    }
  }
}

/// The largest departure from orthonormality of the axes for `l`.
double departure(glm::dvec3 l) {
  const Axes axes = make_axes(l);
  return std::max({std::abs(glm::length(axes.u) - 1), std::abs(glm::length(axes.f) - 1),
                   std::abs(glm::dot(axes.axis, axes.u)), std::abs(glm::dot(axes.axis, axes.f)),
                   std::abs(glm::dot(axes.u, axes.f)), glm::length(glm::cross(axes.u, axes.f) - axes.axis)});
}

TEST(MakeAxes, StayOrthonormalWhereTheLightIsBelow) {
  // 1 + l.y loses digits near −Y: what is left must do for a frame held in single precision.
  Random random(2);
  double worst = 0.0;
  for (int i = 0; i < 50000; ++i) {
    const double tilt = random.logarithmic(1e-9, 0.1), turn = random.uniform(0, 2 * pi);
    const glm::dvec3 l(std::sin(tilt) * std::cos(turn), -std::cos(tilt), std::sin(tilt) * std::sin(turn));
    worst = std::max(worst, departure(l));
  }
  EXPECT_LT(worst, 1e-3);
  RecordProperty("worst", std::to_string(worst));
  for (double tilt : {1e-2, 1e-3, 1e-4}) {
    EXPECT_LT(departure({std::sin(tilt), -std::cos(tilt), 0}), 1e-7) << "a light that is 0.01° or more off";
  }
}

TEST(MakeAxes, AreContinuousAwayFromStraightDown) {
  Random random(3);
  for (int i = 0; i < 50000; ++i) {
    const glm::dvec3 l = random.direction();
    if (l.y < -0.99) continue;
    const double step = 1e-6;
    const glm::dvec3 moved = glm::normalize(l + step * random.direction());
    const Axes a = make_axes(l), b = make_axes(moved);
    // The pair turns by at most tan(half the angle from +Y) times the step.
    const double bound = step * (1.0 + std::sqrt((1 - l.y) / (1 + l.y)) * 1.1);
    EXPECT_LT(glm::length(a.u - b.u), 2 * bound);
    EXPECT_LT(glm::length(a.f - b.f), 2 * bound);
  }
}

TEST(MakeAxes, DoNotSpinWithTheCamera) {
  scene::View view;
  view.camera.eye = {1, 2, 3};
  view.lights[0].position = {-2, 4, 1};
  Random random(4);
  view.camera.target = {0, 0, 0};
  const shaders::EpipolarBlock first =
      epipolar_block(view, view.lights[0], {64, 64, 128}, Ranges::frame, ThetaCells::fitted);
  for (int i = 0; i < 100; ++i) {
    view.camera.target = random.in_box(10);
    view.camera.up = random.direction();
    const shaders::EpipolarBlock block =
        epipolar_block(view, view.lights[0], {64, 64, 128}, Ranges::frame, ThetaCells::fitted);
    EXPECT_EQ(block.axis, first.axis);
    EXPECT_EQ(block.u, first.u);
    EXPECT_EQ(block.f, first.f);
    EXPECT_EQ(block.distance, first.distance);
  }
}

/// A camera at the origin that looks along `forward`.
scene::CameraFrame look(glm::dvec3 forward, double fov, glm::ivec2 size) {
  scene::Camera camera;
  camera.target = forward;
  camera.vertical_fov_degrees = fov;
  camera.up = std::abs(forward.y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return scene::camera_frame(camera, size);
}

/// Brute force: the angles of a fine lattice over the image.
Range scan(const scene::CameraFrame& camera, glm::dvec3 axis, int steps) {
  Range range{10, 0};
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const double angle =
          angle_between(axis, tests::view_ray(camera, 2.0 * i / steps - 1, 2.0 * j / steps - 1));
      range.lower = std::min(range.lower, angle);
      range.upper = std::max(range.upper, angle);
    }
  }
  return range;
}

void expect_range(const scene::CameraFrame& camera, glm::dvec3 axis) {
  const int steps = 64;
  const Range range = alpha_range(camera, axis), brute = scan(camera, axis, steps);
  EXPECT_LE(range.lower, brute.lower + 1e-9) << "every ray of the image is in the range";
  EXPECT_GE(range.upper, brute.upper - 1e-9);
  // The lattice misses the extreme by less than the diagonal of a cell.
  const double cell = 2.0 * std::hypot(camera.half_width, camera.half_height) / steps;
  EXPECT_GT(range.lower, brute.lower - cell) << "and the range is no larger than needed";
  EXPECT_LT(range.upper, brute.upper + cell);
}

TEST(AlphaRange, IsThatOfAScanOfTheImage) {
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    const glm::ivec2 size(1 + static_cast<int>(random.uniform(0, 200)),
                          1 + static_cast<int>(random.uniform(0, 200)));
    expect_range(look(random.direction(), random.uniform(1, 100), size), random.direction());
  }
}

TEST(AlphaRange, OfALightInFrontStartsAtZero) {
  const auto camera = look({1, 2, 3}, 50, {64, 48});
  const Range range = alpha_range(camera, camera.forward);
  EXPECT_EQ(range.lower, 0.0);
  EXPECT_NEAR(range.upper, std::atan(std::hypot(camera.half_width, camera.half_height)), 1e-12);
  expect_range(camera, camera.forward);
}

TEST(AlphaRange, OfALightBehindEndsAtPi) {
  const auto camera = look({1, 2, 3}, 50, {64, 48});
  const Range range = alpha_range(camera, -camera.forward);
  EXPECT_EQ(range.upper, pi);
  EXPECT_NEAR(range.lower, pi - std::atan(std::hypot(camera.half_width, camera.half_height)), 1e-12);
  expect_range(camera, -camera.forward);
}

TEST(AlphaRange, HoldsWhereTheEpipoleIsOnAnEdgeOrACorner) {
  const auto camera = look({1, 0.2, -1}, 60, {80, 50});
  for (double sign : {1.0, -1.0}) {
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {1.0, 0.37}, {-0.2, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
      const glm::dvec3 axis = sign * tests::view_ray(camera, x, y);
      expect_range(camera, axis);
      const Range range = alpha_range(camera, axis);
      // Whether the axis counts as inside is a matter of rounding; the range reaches it either way.
      EXPECT_NEAR(sign > 0 ? range.lower : pi - range.upper, 0.0, 1e-7);
    }
  }
}

TEST(AlphaRange, FindsTheStationaryPointOfAnEdge) {
  // The light is above the image: the nearest ray is in the middle of the upper edge, not at a corner.
  const auto camera = look({0, 0, -1}, 40, {100, 100});
  const Range range = alpha_range(camera, {0, 1, 0});
  EXPECT_NEAR(range.lower, pi / 2 - glm::radians(20.0), 1e-12);
  EXPECT_NEAR(range.upper, pi / 2 + glm::radians(20.0), 1e-12);
}

TEST(EpipolarBlock, SpansTheRangeWithItsCells) {
  scene::View view;
  view.camera.eye = {1, 2, 3};
  view.camera.target = {0, 1, 0};
  view.lights[0].position = {4, 4, -2};
  view.size = {100, 60};
  const shaders::EpipolarBlock block =
      epipolar_block(view, view.lights[0], {100, 64, 128}, Ranges::frame, ThetaCells::fitted);
  const Range range = alpha_range(scene::camera_frame(view.camera, view.size),
                                  glm::normalize(view.lights[0].position - view.camera.eye));
  EXPECT_FLOAT_EQ(static_cast<float>(block.alpha_min), static_cast<float>(range.lower));
  EXPECT_NEAR(static_cast<double>(shaders::alpha_of_cell(block, shaders::Cell(100.0f))), range.upper, 1e-6);
  EXPECT_FLOAT_EQ(block.distance, static_cast<float>(std::sqrt(9.0 + 4.0 + 25.0)));
}

TEST(EpipolarBlock, KeepsItsAxesFarFromTheOrigin) {
  scene::View near;
  near.camera.eye = {1, 2, 3};
  near.camera.target = {0, 1, 0};
  near.lights[0].position = {4, 4, -2};
  scene::View far = near;
  const glm::dvec3 offset(1048576, -2097152, 4194304);
  far.camera.eye += offset;
  far.camera.target += offset;
  far.lights[0].position += offset;
  const shaders::EpipolarBlock a = epipolar_block(near, near.lights[0], {64, 64, 128}, Ranges::frame,
                                                  ThetaCells::fitted),
                               b = epipolar_block(far, far.lights[0], {64, 64, 128}, Ranges::frame,
                                                  ThetaCells::fitted);
  EXPECT_EQ(a.axis, b.axis);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.alpha_min, b.alpha_min);
}

double theta_of_ray(const Axes& axes, glm::dvec3 ray) {
  return std::atan2(glm::dot(ray, axes.f), glm::dot(ray, axes.u));
}

TEST(ThetaRange, HoldsEveryRayAndTouchesSome) {
  tests::Random random(20);
  int full = 0, partial = 0;
  for (int trial = 0; trial < 300; ++trial) {
    scene::View view;
    view.camera.target = random.direction();
    view.camera.vertical_fov_degrees = random.uniform(20, 100);
    view.size = {80, 60};
    view.lights[0].position = 3.0 * random.direction();
    const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
    const Axes axes = make_axes(glm::normalize(view.lights[0].position));
    const Range range = theta_range(camera, axes);
    const double middle = 0.5 * (range.lower + range.upper), half = 0.5 * (range.upper - range.lower);
    double farthest = 0.0;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const glm::dvec3 ray = tests::view_ray(camera, i / 20.0 - 1, j / 20.0 - 1);
        const double from_middle = std::remainder(theta_of_ray(axes, ray) - middle, 2 * std::numbers::pi);
        EXPECT_LE(std::abs(from_middle), half + 1e-9);
        farthest = std::max(farthest, std::abs(from_middle));
      }
    }
    const bool is_full = half > std::numbers::pi - 1e-9;
    ++(is_full ? full : partial);
    if (!is_full) {
      EXPECT_NEAR(farthest, half, 1e-9);
      EXPECT_LT(half, 0.5 * std::numbers::pi + 1e-9);
    }
  }
  EXPECT_GT(full, 20);
  EXPECT_GT(partial, 100);
}

TEST(PixelExact, RowsAreNowhereMoreThanAPixelApart) {
  tests::Random random(21);
  for (int trial = 0; trial < 60; ++trial) {
    scene::View view;
    view.camera.target = {0, 0, -1};
    view.camera.vertical_fov_degrees = random.uniform(20, 90);
    view.size = {160, 120};
    const double spread = trial % 2 == 0 ? 0.5 : 3.0;  // in view, or often not
    view.lights[0].position = {random.uniform(-spread, spread), random.uniform(-spread, spread), -2.0};
    const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
    const Axes axes = make_axes(glm::normalize(view.lights[0].position));
    for (const ThetaCells cells : {ThetaCells::fitted, ThetaCells::equal}) {
      const Resolution n = pixel_exact(view, view.lights[0], Ranges::frame, cells);
      const shaders::EpipolarBlock space = epipolar_block(view, view.lights[0], n, Ranges::frame, cells);
      double most_alpha = 0.0, most_theta = 0.0;
      for (int sample = 0; sample < 2000; ++sample) {
        // The rays of two neighbouring pixels, in either direction.
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        const auto ray = [&](double dx, double dy) { return tests::view_ray(camera, x + dx, y + dy); };
        const glm::dvec3 a = ray(0, 0);
        // One row to the next on the sphere, over what a pixel spans there at least.
        const double pixel =
            std::min(glm::length(ray(2.0 / view.size.x, 0) - a), glm::length(ray(0, 2.0 / view.size.y) - a));
        const double from_middle = std::remainder(
            theta_of_ray(axes, a) - static_cast<double>(space.theta_middle), 2 * std::numbers::pi);
        const double plane = static_cast<double>(space.theta_step) /
                             (1 + static_cast<double>(space.theta_growth) * std::cos(from_middle));
        most_theta = std::max(most_theta, glm::length(glm::cross(axes.axis, a)) * plane / pixel);
        const double row = tests::cells_of_alpha(space, angle_between(axes.axis, a));
        most_alpha = std::max(most_alpha, (tests::alpha_of_cells(space, row + 0.5) -
                                           tests::alpha_of_cells(space, std::max(row - 0.5, 0.0))) /
                                              pixel);
      }
      // 1.5 %: the border is sampled in 256 steps of θ, and a pixel is measured over its own width.
      EXPECT_LT(most_theta, 1.015);
      EXPECT_LT(most_alpha, 1.015);
      EXPECT_GT(most_theta, 0.5);
      EXPECT_GT(most_alpha, 0.5);
    }
  }
}

/// A box, an eye and a light, each in any place, and the epipolar space that they make.
struct BoxScene {
  scene::Box box;
  scene::View view;
};

/// @param kind of the light: 0 beside the box or in it, 1 far away, 2 a sun
BoxScene random_box_scene(Random& random, int kind) {
  BoxScene scene;
  const glm::dvec3 centre = random.in_box(1.0);
  for (int i = 0; i < 2; ++i)
    scene.box.include(glm::vec3(centre + random.in_box(random.logarithmic(0.2, 3.0))));
  scene.view.camera.eye = random.in_box(4.0);
  scene.view.camera.target = scene.view.camera.eye + random.direction();
  scene.view.camera.up = random.direction();
  scene.view.size = {80, 60};
  scene::Light& light = scene.view.lights[0];
  if (kind == 0) light.position = random.in_box(4.0);
  if (kind == 1) light.position = random.logarithmic(5, 500) * random.direction();
  if (kind == 2) light = scene::sun("", random.direction(), glm::vec3(1.0f));
  return scene;
}

/// The θ, in cells, and φ of a point; false where the grid does not cover its θ, or the point is within a
/// thousandth of a cell of a border, where single precision decides on its plane.
bool plane_and_phi(const shaders::EpipolarBlock& space, glm::dvec3 relative, std::size_t& plane,
                   double& phi) {
  const double x = glm::dot(relative, glm::dvec3(space.u)), y = glm::dot(relative, glm::dvec3(space.f)),
               z = glm::dot(relative, glm::dvec3(space.axis)), across = std::hypot(x, y);
  const double cell = tests::cells_of_theta(space, std::atan2(y, x));
  const double count = std::round(static_cast<double>(2.0f * space.theta_half / space.theta_step));
  if (cell < 0.0 || cell >= count || std::abs(cell - std::round(cell)) < 1e-3) return false;
  plane = static_cast<std::size_t>(cell);
  phi = shaders::is_sun(space) ? across : std::atan2(across, static_cast<double>(space.distance) - z);
  return true;
}

class BoxRanges : public testing::TestWithParam<int> {};

TEST_P(BoxRanges, HoldThePhiOfEveryPointAndLittleMore) {
  Random random(30);
  int about_the_axis = 0;
  double length = 0.0, needed = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const BoxScene scene = random_box_scene(random, GetParam());
    const int planes = trial % 4 == 0 ? 7 : 128;
    const shaders::EpipolarBlock space =
        epipolar_block(scene.view, scene.view.lights[0], {8, planes, 128}, Ranges::frame,
                       trial % 2 == 0 ? ThetaCells::fitted : ThetaCells::equal);
    const glm::dvec3 eye = scene.view.camera.eye;
    const std::vector<glm::vec2> ranges = box_ranges(scene.box, eye, space, planes);
    ASSERT_EQ(ranges.size(), static_cast<std::size_t>(planes));
    const glm::dvec3 lower(scene.box.lower), size = glm::dvec3(scene.box.upper) - lower;
    // On the axis every half-plane has φ = 0 before the light, π beyond it.
    std::vector<Range> found(ranges.size(), Range{10.0 * static_cast<double>(shaders::k_endless_phi), -1.0});
    for (double z = -10.0; z < 10.0; z += 1e-3) {
      const glm::dvec3 at = (eye + z * glm::dvec3(space.axis) - lower) / size;
      if (at != glm::clamp(at, glm::dvec3(0.0), glm::dvec3(1.0))) continue;
      const double phi = !shaders::is_sun(space) && z > static_cast<double>(space.distance) ? pi : 0.0;
      for (Range& range : found) {
        range.lower = std::min(range.lower, phi);
        range.upper = std::max(range.upper, phi);
      }
    }
    for (int sample = 0; sample < 60000; ++sample) {
      // On edges, where the other extremes are, and anywhere.
      glm::dvec3 at(random.uniform(), random.uniform(), random.uniform());
      const int along = sample % 4;
      for (int i = 0; i < 3 && along < 3; ++i) {
        if (i != along) at[i] = std::round(at[i]);
      }
      std::size_t plane = 0;
      double phi = 0.0;
      if (!plane_and_phi(space, lower + at * size - eye, plane, phi)) continue;
      ASSERT_GE(phi, static_cast<double>(ranges[plane].x)) << trial << ", plane " << plane;
      ASSERT_LE(phi, static_cast<double>(ranges[plane].y)) << trial << ", plane " << plane;
      found[plane].lower = std::min(found[plane].lower, phi);
      found[plane].upper = std::max(found[plane].upper, phi);
    }
    // In units of the largest φ, so that suns' scenes count alike.
    double largest = 0.0;
    for (const glm::vec2& range : ranges) largest = std::max(largest, static_cast<double>(range.y));
    for (std::size_t plane = 0; planes == 128 && plane < ranges.size(); ++plane) {
      if (found[plane].upper < 0.0) continue;
      length += static_cast<double>(ranges[plane].y - ranges[plane].x) / largest;
      needed += (found[plane].upper - found[plane].lower) / largest;
    }
    about_the_axis +=
        std::all_of(ranges.begin(), ranges.end(), [](glm::vec2 range) { return range.x == 0.0f; });
  }
  EXPECT_GT(about_the_axis, 5);
  RecordProperty("more", std::to_string(length / needed - 1.0));
  EXPECT_LT(length, 1.05 * needed) << "what the cells' width takes, and too few points";
}

INSTANTIATE_TEST_SUITE_P(NearFarAndSun, BoxRanges, testing::Values(0, 1, 2));

TEST(BoxRange, OfABoxThatIsNotMetIsEmpty) {
  scene::View view;
  view.camera.eye = {0, 0, 0};
  view.lights[0].position = {0, 10, 0};
  const shaders::EpipolarBlock space =
      epipolar_block(view, view.lights[0], {8, 64, 128}, Ranges::full, ThetaCells::equal);
  scene::Box box;
  for (const glm::vec2& range : box_ranges(box, view.camera.eye, space, 64))
    EXPECT_EQ(range, glm::vec2(0.0f));
  box.include({2, -1, -1});
  box.include({3, 1, 1});
  int met = 0;
  for (const glm::vec2& range : box_ranges(box, view.camera.eye, space, 64)) {
    met += range.y > 0.0f;
    EXPECT_TRUE(range == glm::vec2(0.0f) || range.x > 0.0f);
  }
  // Of the turn it takes twice atan(1/2), and parts of two cells more.
  EXPECT_NEAR(met, 64 * 2 * std::atan(0.5) / (2 * pi), 2.0);
}

TEST(BoxRange, ReachesPiBeyondTheLight) {
  scene::View view;
  view.camera.eye = {0, 0, 0};
  view.lights[0].position = {0, 2, 0};
  const shaders::EpipolarBlock space =
      epipolar_block(view, view.lights[0], {8, 64, 128}, Ranges::full, ThetaCells::equal);
  scene::Box box;
  box.include({-1, 3, -1});
  box.include({1, 4, 1});
  for (const glm::vec2& range : box_ranges(box, view.camera.eye, space, 64)) {
    EXPECT_FLOAT_EQ(range.y, static_cast<float>(pi));
    // The lowest is on the edges of the lower face, from the middle of one to its end, less what a cell's
    // width takes.
    EXPECT_GT(range.x, pi / 2 + std::atan(1.0 / std::sqrt(2.0)) - 0.02);
    EXPECT_LT(range.x, pi / 2 + std::atan(1.0) + 1e-6);
  }
}

}  // namespace
}  // namespace airlight::epipolar
