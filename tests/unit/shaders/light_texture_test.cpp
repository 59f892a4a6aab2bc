#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "frame/blocks.h"

/// shaders/frame/light_texture.glsl.
namespace airlight::shaders {
namespace {

void expect_place(glm::vec3 direction, float x, float y) {
  const glm::vec2 place = light_texture_place(std::atan2(direction.x, direction.z),
                                              std::atan2(direction.y, std::hypot(direction.x, direction.z)));
  EXPECT_NEAR(place.x, x, 1e-6f);
  EXPECT_NEAR(place.y, y, 1e-6f);
}

TEST(LightTexturePlace, FollowsTheConvention) {
  expect_place({0, 0, 1}, 0.5f, 0.5f);
  expect_place({1, 0, 0}, 0.25f, 0.5f);
  expect_place({-1, 0, 0}, 0.75f, 0.5f);
  expect_place({1e-9f, 0, -1}, 0.0f, 0.5f);
  expect_place({-1e-9f, 0, -1}, 1.0f, 0.5f);
  expect_place({0, 1, 0}, 0.5f, 0.0f);
  expect_place({0, -1, 0}, 0.5f, 1.0f);
  expect_place({1, std::numbers::sqrt2_v<float>, 1}, 0.375f, 0.25f);
}

}  // namespace
}  // namespace airlight::shaders
