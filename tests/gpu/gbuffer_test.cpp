#include "frame/gbuffer.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reference/reference.h"
#include "scene/error.h"
#include "support/frame_probe.h"
#include "support/scenes.h"

namespace airlight::frame {
namespace {

using tests::builtin;
using tests::look_into_frame;
using tests::view_of;

/// How many pixels see something else than exact rays do.
std::size_t differing_pixels(const scene::Geometry& geometry, const scene::View& view) {
  const reference::SurfaceImage exact = reference::Reference(geometry, view).surfaces();
  std::size_t differing = 0;
  look_into_frame(geometry, view, 16, [&](const FrameInputs& inputs) {
    const std::vector<float> distance = tests::distances(inputs);
    ASSERT_EQ(distance.size(), exact.distance.size());
    for (std::size_t i = 0; i < distance.size(); ++i) {
      EXPECT_GE(distance[i], 0.0f);
      // Corners relative to the eye are single-precision numbers, and so are the rays.
      differing += std::abs(distance[i] - exact.distance[i]) > 1e-4f * exact.distance[i];
    }
  });
  return differing;
}

class GBufferOf : public testing::TestWithParam<const char*> {};

TEST_P(GBufferOf, HoldsTheDistancesOfRaysThroughItsPixels) {
  const scene::Scene& scene = builtin(GetParam());
  const scene::View view = view_of(scene, {160, 120});
  const std::size_t differing = differing_pixels(scene.geometry, view);
  RecordProperty("differing", static_cast<int>(differing));
  // Rasterisation snaps corners to 1/256 pixel: a pixel centre that near to a silhouette may fall on its
  // other side.
  EXPECT_LE(differing, 160u * 120u / 500u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GBufferOf,
                         testing::Values("cornell", "window", "sphere", "half-space", "empty"));

TEST(GBuffer, SeesTrianglesThatReachBehindTheEye) {
  scene::Geometry floor;
  tests::add_quad(floor, {-1000, 0, -1000}, {2000, 0, 0}, {0, 0, 2000});
  tests::add_quad(floor, {-1000, 3, -1000}, {2000, 0, 0}, {0, 0, 2000});
  scene::View view;
  view.camera.eye = {0.3, 1.0, 0.2};
  view.camera.target = {5, 0.9, 3};
  view.camera.vertical_fov_degrees = 70;
  view.lights[0].position = {2, 2, 2};
  view.size = {97, 65};
  EXPECT_LE(differing_pixels(floor, view), 5u);
}

/// A wall, seen from 9 m.
scene::Geometry wall() {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-9, -9, -5}, {18, 0, 0}, {0, 18, 0});
  return geometry;
}

scene::View view_of_wall() {
  scene::View view;
  view.camera.eye = {0, 1.5, 4};
  view.camera.target = {0, 1.5, 0};
  view.lights[0].position = {0.3, 1.9, -3};
  view.size = {64, 64};
  return view;
}

TEST(GBuffer, OrdersTrianglesATenthOfAMillimetreBeforeTheEye) {
  scene::Geometry geometry = wall();
  for (const float depth : {2e-4f, 1e-4f})
    tests::add_triangle(geometry, {-0.3f * depth, 1.5f - 0.2f * depth, 4 - depth},
                        {0.3f * depth, 1.5f - 0.2f * depth, 4 - depth}, {0, 1.5f + 0.3f * depth, 4 - depth});
  look_into_frame(geometry, view_of_wall(), 16, [&](const FrameInputs& inputs) {
    EXPECT_NEAR(tests::distances(inputs)[32 * 64 + 32], 1e-4f, 1e-6f);
  });
}

TEST(GBuffer, LooksPastATriangleOnWhichTheEyeIs) {
  const scene::View view = view_of_wall();
  const glm::vec3 eye(view.camera.eye);
  const struct {
    const char* eye_is;
    glm::vec3 a, b, c;  // relative to it
  } triangles[] = {{"at a corner", {0, 0, 0}, {0.3, 0.2, -2}, {-0.9, -0.6, -2}},
                   {"on an edge", {0, 0, 0.4}, {0.3, 0.2, -2}, {0, 0, -2}},
                   {"inside", {0, 0, 0.4}, {0.3, 0.2, -2}, {-0.3, -0.2, -2}}};
  for (const auto& [eye_is, a, b, c] : triangles) {
    scene::Geometry geometry = wall();
    tests::add_triangle(geometry, eye + a, eye + b, eye + c);
    look_into_frame(geometry, view, 16, [&](const FrameInputs& inputs) {
      for (const float distance : tests::distances(inputs)) EXPECT_GT(distance, 8.9f) << eye_is;
    });
  }
}

TEST(GBuffer, FarFromTheOriginSeesTheSame) {
  scene::Geometry geometry;
  const glm::vec3 offset(1048576, -524288, 2097152);
  tests::add_box(geometry, offset + glm::vec3(-1, -1, -1), offset + glm::vec3(1, 1, 1));
  scene::View view;
  view.camera.eye = glm::dvec3(offset) + glm::dvec3(2.1, 1.3, 4.7);
  view.camera.target = offset;
  view.lights[0].position = glm::dvec3(offset) + glm::dvec3(-3, 3, 3);
  view.size = {96, 96};
  EXPECT_LE(differing_pixels(geometry, view), 5u);
}

TEST(GBuffer, ImagesNeedNotFillWorkGroups) {
  const scene::Scene& scene = builtin("cornell");
  for (glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 33), glm::ivec2(33, 1), glm::ivec2(17, 9)}) {
    EXPECT_LE(differing_pixels(scene.geometry, view_of(scene, size)), 1u) << size.x << "x" << size.y;
  }
}

TEST(GBuffer, AnImageOverTheDriversLimitIsAnErrorThatNamesIt) {
  const scene::Scene& scene = builtin("empty");
  try {
    look_into_frame(scene.geometry, view_of(scene, {tests::gpu_context().limits().max_texture_size + 1, 1}),
                    16, [](const FrameInputs&) {});
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), testing::HasSubstr("GL_MAX_TEXTURE_SIZE"));
  }
}

}  // namespace
}  // namespace airlight::frame
