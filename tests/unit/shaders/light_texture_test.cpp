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

void expect_blend(glm::vec2 place, glm::ivec2 from, glm::ivec2 to, glm::vec2 weight) {
  const TexelBlend blend = light_texture_blend(place, {8, 4});
  EXPECT_EQ(blend.from, from);
  EXPECT_EQ(blend.to, to);
  EXPECT_NEAR(blend.weight.x, weight.x, 1e-6f);
  EXPECT_NEAR(blend.weight.y, weight.y, 1e-6f);
}

TEST(LightTextureBlend, GoesAroundTheAzimuthAndEndsAtThePoles) {
  expect_blend({1.5f / 8, 1.5f / 4}, {1, 1}, {2, 2}, {0, 0});  // a texel's centre
  expect_blend({1.75f / 8, 2.0f / 4}, {1, 1}, {2, 2}, {0.25f, 0.5f});
  expect_blend({0.0f, 1.5f / 4}, {7, 1}, {0, 2}, {0.5f, 0.0f});
  expect_blend({1.0f, 1.5f / 4}, {7, 1}, {0, 2}, {0.5f, 0.0f});
  expect_blend({1.5f / 8, 0.0f}, {1, 0}, {2, 0}, {0.0f, 0.5f});
  expect_blend({1.5f / 8, 1.0f}, {1, 3}, {2, 3}, {0.0f, 0.5f});
  // A place rounded a little off the image.
  expect_blend({-1e-7f, -1e-7f}, {7, 0}, {0, 0}, {0.5f, 0.5f});
  expect_blend({1.0000001f, 1.0000001f}, {7, 3}, {0, 3}, {0.5f, 0.5f});
}

TEST(LightTextureBlend, OfASingleTexelIsThatTexel) {
  for (const float place : {0.0f, 0.3f, 0.5f, 1.0f}) {
    const TexelBlend blend = light_texture_blend({place, place}, {1, 1});
    EXPECT_EQ(blend.from, glm::ivec2(0));
    EXPECT_EQ(blend.to, glm::ivec2(0));
  }
}

}  // namespace
}  // namespace airlight::shaders
