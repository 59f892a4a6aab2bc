#include "epipolar/space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/random.h"

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
  view.light.position = {-2, 4, 1};
  Random random(4);
  view.camera.target = {0, 0, 0};
  const shaders::EpipolarBlock first = epipolar_block(view, {64, 64, 128}, Ranges::frame, ThetaCells::fitted);
  for (int i = 0; i < 100; ++i) {
    view.camera.target = random.in_box(10);
    view.camera.up = random.direction();
    const shaders::EpipolarBlock block =
        epipolar_block(view, {64, 64, 128}, Ranges::frame, ThetaCells::fitted);
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

glm::dvec3 ray_at(const scene::CameraFrame& camera, double x, double y) {
  return camera.forward + x * camera.half_width * camera.right + y * camera.half_height * camera.up;
}

/// Brute force: the angles of a fine lattice over the image.
Range scan(const scene::CameraFrame& camera, glm::dvec3 axis, int steps) {
  Range range{10, 0};
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const double angle = angle_between(axis, ray_at(camera, 2.0 * i / steps - 1, 2.0 * j / steps - 1));
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
      const glm::dvec3 axis = sign * glm::normalize(ray_at(camera, x, y));
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
  view.light.position = {4, 4, -2};
  view.size = {100, 60};
  const shaders::EpipolarBlock block =
      epipolar_block(view, {100, 64, 128}, Ranges::frame, ThetaCells::fitted);
  const Range range = alpha_range(scene::camera_frame(view.camera, view.size),
                                  glm::normalize(view.light.position - view.camera.eye));
  EXPECT_FLOAT_EQ(block.alpha_min, static_cast<float>(range.lower));
  EXPECT_NEAR(static_cast<double>(block.alpha_min + 100 * block.alpha_step), range.upper, 1e-6);
  EXPECT_FLOAT_EQ(block.distance, static_cast<float>(std::sqrt(9.0 + 4.0 + 25.0)));
}

TEST(EpipolarBlock, KeepsItsAxesFarFromTheOrigin) {
  scene::View near;
  near.camera.eye = {1, 2, 3};
  near.camera.target = {0, 1, 0};
  near.light.position = {4, 4, -2};
  scene::View far = near;
  const glm::dvec3 offset(1048576, -2097152, 4194304);
  far.camera.eye += offset;
  far.camera.target += offset;
  far.light.position += offset;
  const shaders::EpipolarBlock a = epipolar_block(near, {64, 64, 128}, Ranges::frame, ThetaCells::fitted),
                               b = epipolar_block(far, {64, 64, 128}, Ranges::frame, ThetaCells::fitted);
  EXPECT_EQ(a.axis, b.axis);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.alpha_min, b.alpha_min);
}

}  // namespace
}  // namespace airlight::epipolar
