#include <cmath>

#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "scene/scene.h"
#include "support/random.h"

/// shaders/frame/camera.glsl.
namespace airlight::shaders {
namespace {

using tests::Random;

CameraBlock make_camera(const scene::Camera& pinhole, glm::ivec2 size) {
  return frame::camera_block(scene::camera_frame(pinhole, size), size, 0.1f);
}

TEST(ViewRay, GoesThroughTheCentreAndTheCorners) {
  const CameraBlock camera =
      make_camera({.name = {}, .eye = {1, 2, 3}, .target = {4, -1, 2}, .vertical_fov_degrees = 60}, {40, 20});
  const glm::vec3 centre = view_ray(camera, {20.0f, 10.0f});
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(centre[axis], camera.forward[axis], 1e-6f);
  const glm::vec3 top_left = view_ray(camera, {0.0f, 0.0f});
  EXPECT_NEAR(glm::dot(top_left, camera.up) / glm::dot(top_left, camera.forward), camera.half_height, 1e-6f)
      << "row 0 is at the top";
  EXPECT_NEAR(glm::dot(top_left, camera.right) / glm::dot(top_left, camera.forward), -camera.half_width,
              1e-6f);
  const glm::vec3 bottom_right = view_ray(camera, {40.0f, 20.0f});
  EXPECT_NEAR(glm::dot(bottom_right, camera.up) / glm::dot(bottom_right, camera.forward), -camera.half_height,
              1e-6f);
  EXPECT_NEAR(glm::dot(bottom_right, camera.right) / glm::dot(bottom_right, camera.forward),
              camera.half_width, 1e-6f);
}

TEST(ViewRay, IsTheDoublePrecisionRayOfTheCamera) {
  Random random(12);
  for (int i = 0; i < 5000; ++i) {
    const scene::Camera pinhole{.name = {},
                                .eye = random.in_box(5),
                                .target = random.in_box(5),
                                .vertical_fov_degrees = random.uniform(5, 120)};
    const glm::ivec2 size(1 + static_cast<int>(random.uniform(0, 300)),
                          1 + static_cast<int>(random.uniform(0, 300)));
    const scene::CameraFrame frame = scene::camera_frame(pinhole, size);
    const CameraBlock camera = make_camera(pinhole, size);
    const double x = random.uniform(0, size.x), y = random.uniform(0, size.y);
    const glm::dvec3 expected =
        glm::normalize(frame.forward + (2 * x / size.x - 1) * frame.half_width * frame.right +
                       (1 - 2 * y / size.y) * frame.half_height * frame.up);
    const glm::vec3 ray = view_ray(camera, glm::vec2(x, y));
    EXPECT_LT(glm::length(glm::dvec3(ray) - expected), 1e-6);
    EXPECT_NEAR(glm::length(ray), 1.0f, 3e-7f);
  }
}

TEST(QuarterPixel, IsAQuarterOfTheAngleBetweenNeighboursAtTheCentre) {
  const CameraBlock camera =
      make_camera({.name = {}, .eye = {}, .target = {0, 0, -1}, .vertical_fov_degrees = 45}, {1024, 1024});
  const glm::vec3 a = view_ray(camera, {512.0f, 511.5f}), b = view_ray(camera, {512.0f, 512.5f});
  EXPECT_NEAR(quarter_pixel(camera) / (0.25f * glm::length(glm::cross(a, b))), 1.0f, 1e-3f);
  EXPECT_NEAR(static_cast<double>(quarter_pixel(camera)), 0.25 * 2 * std::tan(glm::radians(22.5)) / 1024,
              1e-10);
}

TEST(EyeRelative, LosesNothingFarFromTheOrigin) {
  // A millimetre beside an eye 1,000 km away, where single precision knows 6 cm: exact as far as the vertex
  // itself is.
  const CameraBlock camera =
      make_camera({.name = {}, .eye = {1e6 + 0.001, -1e6, 3.0}, .target = {0, 0, 0}}, {8, 8});
  const glm::vec3 vertex(1e6f + 0.0625f, -1e6f, 2.0f);
  const glm::vec3 relative = eye_relative(camera, vertex);
  EXPECT_NEAR(static_cast<double>(relative.x), 0.0625 - 0.001, 4e-9) << "the rounding of the result";
  EXPECT_EQ(relative.y, 0.0f);
  EXPECT_EQ(relative.z, -1.0f);
}

TEST(RayTriangleDistance, IsTheDistanceToThePlane) {
  Random random(13);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 a(random.in_box(3)), b(random.in_box(3)), c(random.in_box(3));
    const double u = random.uniform(0.05, 0.95), v = (1 - u) * random.uniform(0.05, 0.95);
    const glm::dvec3 point = (1 - u - v) * glm::dvec3(a) + u * glm::dvec3(b) + v * glm::dvec3(c);
    const glm::dvec3 ray = glm::normalize(point);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
    const double facing = std::abs(glm::dot(glm::normalize(normal), ray));
    if (facing < 0.05 || glm::length(normal) < 0.5) continue;  // rounding of the corners is magnified by both
    EXPECT_NEAR(static_cast<double>(ray_triangle_distance(glm::vec3(ray), a, b, c)), glm::length(point),
                1e-5 / facing);
  }
}

TEST(RayTriangleDistance, TakesNoQuotientThatOverflows) {
  // Edge-on but for a digit far beyond those of the plane's distance.
  const glm::vec3 a(-1, 1, 5), b(1, 1, 5), c(0, 1, 9);
  for (const float slope : {1e-30f, -1e-30f, 1e-38f, 0.0f}) {
    EXPECT_EQ(ray_triangle_distance({0, slope, 1}, a, b, c), 5.0f) << slope;
  }
}

TEST(RayTriangleDistance, StaysWithinATriangleSeenEdgeOn) {
  const glm::vec3 a(-1, 0, 5), b(1, 0, 5), c(0, 0, 9);
  // In the plane of the ray, and a ray that just misses the plane.
  EXPECT_EQ(ray_triangle_distance({0, 0, 1}, a, b, c), 5.0f);
  const float missed = ray_triangle_distance(glm::normalize(glm::vec3(0, 1e-3f, 1)), a, b, c);
  EXPECT_GE(missed, 4.99f);
  EXPECT_LE(missed, 9.0f);
}

}  // namespace
}  // namespace airlight::shaders
