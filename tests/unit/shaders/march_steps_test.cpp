#include <set>

#include <gtest/gtest.h>

#include "media/medium.h"

/// shaders/media/march_steps.glsl.
namespace airlight::shaders {
namespace {

/// The ends of the steps of a march.
std::vector<float> places(float from, float to, float reach, int count) {
  const MarchSteps steps = march_steps(from, to, reach, static_cast<float>(count));
  std::vector<float> places;
  for (int step = 0; step <= count; ++step) places.push_back(place_of_step(steps, static_cast<float>(step)));
  return places;
}

TEST(MarchSteps, AreEquallyLongWithinTheScene) {
  for (const float reach : {7.0f, 8.0f, 1e6f}) {
    const std::vector<float> at = places(3, 7, reach, 16);
    for (std::size_t i = 0; i < at.size(); ++i)
      EXPECT_FLOAT_EQ(at[i], 3.0f + 0.25f * static_cast<float>(i)) << "reach " << reach;
  }
}

TEST(MarchSteps, AnEighthOfThemLiesBeyondTheScene) {
  const std::vector<float> at = places(0, 40, 10, 32);
  for (std::size_t i = 0; i <= 28; ++i) EXPECT_FLOAT_EQ(at[i], static_cast<float>(i) * 10 / 28);
  for (std::size_t i = 28; i <= 32; ++i)  // from 1/10 to 1/40
    EXPECT_NEAR(1 / at[i], 0.1f - 0.075f * static_cast<float>(i - 28) / 4, 1e-6f);
}

TEST(MarchSteps, AllLieBeyondASceneThatEndsBefore) {
  const std::vector<float> at = places(20, 40, 10, 8);
  for (std::size_t i = 0; i <= 8; ++i)
    EXPECT_NEAR(1 / at[i], 0.05f - 0.025f * static_cast<float>(i) / 8, 1e-6f);
}

TEST(MarchSteps, ReachWhereARayNeverEnds) {
  for (const float end : {k_endless, 1e25f}) {
    for (const int count : {8, 9, 512}) {
      const std::vector<float> at = places(0, end, 10, count);
      for (std::size_t i = 1; i < at.size(); ++i) EXPECT_GT(at[i], at[i - 1]);
      EXPECT_GT(at.back(), 0.99f * end);
      EXPECT_LE(at.back(), end);
    }
  }
}

TEST(MarchSteps, StandStillOnARayOfNoLength) {
  for (const float reach : {1.0f, 5.0f, 9.0f})
    for (const float at : places(5, 5, reach, 8)) EXPECT_FLOAT_EQ(at, 5.0f);
}

TEST(InterleavedOffset, HasAllSixteenInEverySquareOfFourPixels) {
  for (int left = 0; left < 4; ++left) {
    for (int top = 0; top < 4; ++top) {
      std::set<float> offsets;
      for (int i = 0; i < 16; ++i) offsets.insert(interleaved_offset(ivec2(left + i % 4, top + i / 4)));
      EXPECT_EQ(offsets.size(), 16u);
      EXPECT_EQ(*offsets.begin(), 0.5f / 16);
      EXPECT_EQ(*offsets.rbegin(), 15.5f / 16);
    }
  }
  // Of the four pixels of a quad each is in a quarter of its own.
  std::set<int> quarters;
  for (int i = 0; i < 4; ++i)
    quarters.insert(static_cast<int>(4 * interleaved_offset(ivec2(6 + i % 2, 2 + i / 2))));
  EXPECT_EQ(quarters.size(), 4u);
}

}  // namespace
}  // namespace airlight::shaders
