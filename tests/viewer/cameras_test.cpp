#include "viewer/cameras.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace airlight::viewer {
namespace {

scene::Camera camera() {
  scene::Camera camera;
  camera.eye = {1, 2, 9};
  camera.target = {-2, 1.5, 3};
  return camera;
}

void expect_near(glm::dvec3 a, glm::dvec3 b, double tolerance = 1e-12) {
  EXPECT_LT(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(Cameras, LookAboutTheEyeAndOrbitTheTarget) {
  const scene::Camera before = camera();
  const double distance = glm::distance(before.eye, before.target);
  scene::Camera looking = before;
  look(looking, 0.3, -0.2);
  EXPECT_EQ(looking.eye, before.eye);
  EXPECT_NEAR(glm::distance(looking.eye, looking.target), distance, 1e-12);
  // To the right and upwards.
  const scene::CameraFrame frame = scene::camera_frame(before, {100, 100});
  EXPECT_GT(glm::dot(looking.target - before.eye, frame.right), 0.1);
  EXPECT_GT(looking.target.y, before.target.y);
  look(looking, -0.3, 0.2);
  expect_near(looking.target, before.target);

  scene::Camera orbiting = before;
  orbit(orbiting, 0.3, -0.2);
  EXPECT_EQ(orbiting.target, before.target);
  EXPECT_NEAR(glm::distance(orbiting.eye, orbiting.target), distance, 1e-12);
  // The scene turns to the right when the eye goes to the left.
  EXPECT_LT(glm::dot(orbiting.eye - before.eye, frame.right), -0.1);
  orbit(orbiting, -0.3, 0.2);
  expect_near(orbiting.eye, before.eye);
}

TEST(Cameras, NeverLookStraightUpOrDown) {
  for (const double down : {-10.0, 10.0}) {
    scene::Camera looking = camera(), orbiting = camera();
    for (int i = 0; i < 3; ++i) {
      look(looking, 0.1, down);
      orbit(orbiting, 0.1, down);
    }
    EXPECT_NO_THROW(scene::camera_frame(looking, {100, 100}));
    EXPECT_NO_THROW(scene::camera_frame(orbiting, {100, 100}));
    EXPECT_GT(std::abs(looking.target.y - looking.eye.y), 5.0);  // but nearly
  }
  // One that does already turns away and is not thrown about.
  scene::Camera up = camera();
  up.target = up.eye + glm::dvec3(1e-4, 6.0, 0.0);
  look(up, 0.0, 0.5);
  EXPECT_NEAR(glm::normalize(up.target - up.eye).y, std::cos(0.5 + 1e-4 / 6.0), 1e-6);
}

TEST(Cameras, PanDollyAndFly) {
  const scene::Camera before = camera();
  scene::Camera moved = before;
  pan(moved, 2.0, -1.0);
  expect_near(moved.eye - before.eye, moved.target - before.target);
  EXPECT_NEAR(glm::dot(moved.eye - before.eye, before.target - before.eye), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(moved.eye - before.eye), std::sqrt(5.0), 1e-12);
  moved = before;
  dolly(moved, std::log(2.0));
  EXPECT_EQ(moved.target, before.target);
  expect_near(moved.eye, 0.5 * (before.eye + before.target));
  dolly(moved, 1000.0);
  EXPECT_NE(moved.eye, moved.target);
  moved = before;
  fly(moved, {0.0, 3.0, 0.0});
  expect_near(moved.eye, before.eye + glm::dvec3(0, 3, 0));
  expect_near(moved.target, before.target + glm::dvec3(0, 3, 0));
  moved = before;
  fly(moved, {0.0, 0.0, 1.0});
  expect_near(moved.eye, before.eye + glm::normalize(before.target - before.eye));
}

TEST(Cameras, ProjectAlongTheirRays) {
  const scene::CameraFrame frame = scene::camera_frame(camera(), {640, 360});
  const glm::dvec2 size(640, 360), place(123.0, 301.0);
  const glm::dvec3 seen = project(frame, size, frame.eye + 4.0 * scene::image_ray(frame, size, place));
  EXPECT_NEAR(seen.x, place.x, 1e-9);
  EXPECT_NEAR(seen.y, place.y, 1e-9);
  EXPECT_NEAR(seen.z, 4.0, 1e-12);
  EXPECT_LT(project(frame, size, frame.eye - frame.forward).z, 0.0);
  // The target is in the middle.
  const glm::dvec3 middle = project(frame, size, camera().target);
  EXPECT_NEAR(middle.x, 320.0, 1e-9);
  EXPECT_NEAR(middle.y, 180.0, 1e-9);
}

}  // namespace
}  // namespace airlight::viewer
