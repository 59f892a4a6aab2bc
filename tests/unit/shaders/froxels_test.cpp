#include <gtest/gtest.h>

#include "media/medium.h"

/// shaders/media/froxels.glsl.
namespace airlight::shaders {
namespace {

TEST(Froxels, SlicesGrowFourfoldFromTheEyeToTheLast) {
  for (const float far : {0.01f, 30.0f, 1e6f}) {
    for (const float count : {8.0f, 64.0f, 512.0f}) {
      EXPECT_EQ(depth_of_slice(0, count, far), 0.0f);
      EXPECT_NEAR(depth_of_slice(count, count, far), far, 1e-6f * far);
      const float first = depth_of_slice(1, count, far);
      const float last = far - depth_of_slice(count - 1, count, far);
      const float before_last = depth_of_slice(count - 1, count, far) - depth_of_slice(count - 2, count, far);
      // Thicker by one ratio, of which `count` are 4; near the eye e^x − 1 has fewer digits.
      EXPECT_NEAR(last / before_last, std::pow(4.0f, 1 / count), 1e-4f * count / 8);
      EXPECT_NEAR(last / first, 4 * std::pow(4.0f, -1 / count), 1e-4f * count);
    }
  }
}

TEST(Froxels, DepthAndSliceAreInverse) {
  for (const float far : {0.01f, 30.0f, 1e6f}) {
    for (float slice = 0.0f; slice <= 64.0f; slice += 0.37f)
      EXPECT_NEAR(slice_of_depth(depth_of_slice(slice, 64, far), 64, far), slice, 2e-5f);
  }
}

TEST(Froxels, PlacesAreThoseOfTheImageAndOfSlices) {
  CameraBlock camera{};
  camera.half_width = 0.8f;
  camera.half_height = 0.5f;
  camera.right = {0, 0, -1};
  camera.up = {0.6f, 0.8f, 0};
  camera.forward = {0.8f, -0.6f, 0};
  camera.image_width = 160;
  camera.image_height = 100;
  for (const vec2 pixel : {vec2(0, 0), vec2(80, 50), vec2(160, 100), vec2(12.5f, 77.3f)}) {
    for (const float depth : {0.1f, 3.0f, 40.0f}) {
      const vec3 ray = view_ray(camera, pixel);
      const vec3 place = place_in_slices(camera, depth / dot(ray, camera.forward) * ray, 64, 20);
      EXPECT_NEAR(place.x, pixel.x, 1e-4f);
      EXPECT_NEAR(place.y, pixel.y, 1e-4f);
      EXPECT_NEAR(place.z, slice_of_depth(depth, 64, 20), 1e-4f);
      EXPECT_EQ(place_in_slices(camera, -depth * ray, 64, 20).z, -1.0f);
    }
  }
}

TEST(Froxels, LookUpsFillThemEvenly) {
  EXPECT_EQ(place_in_froxel(0), vec3(0.5f));
  // Each eighth of a froxel has some of the first 64.
  int in_eighth[8] = {};
  for (uint i = 0; i < 64; ++i) {
    const vec3 place = place_in_froxel(i);
    for (int side = 0; side < 3; ++side) {
      EXPECT_GE(place[side], 0.0f);
      EXPECT_LT(place[side], 1.0f);
    }
    ++in_eighth[(place.x < 0.5f ? 0 : 1) + (place.y < 0.5f ? 0 : 2) + (place.z < 0.5f ? 0 : 4)];
  }
  for (const int count : in_eighth) EXPECT_NEAR(count, 8, 4);
}

}  // namespace
}  // namespace airlight::shaders
