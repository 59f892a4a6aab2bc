#include "quality/tone_map.h"

#include <gtest/gtest.h>

namespace airlight::quality {
namespace {

using scene::ToneMap;

void expect_near(glm::vec3 shown, glm::vec3 expected) {
  // Worked by hand to five digits.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(shown[i], expected[i], 1e-5f) << "channel " << i;
}

TEST(ToneMap, NoneClamps) {
  EXPECT_EQ(tone_mapped(ToneMap::none, {0.25f, 1.0f, 7.0f}), glm::vec3(0.25f, 1.0f, 1.0f));
}

TEST(ToneMap, ReinhardDividesByOneAndTheLuminance) {
  expect_near(tone_mapped(ToneMap::reinhard, glm::vec3(1.0f)), glm::vec3(0.5f));
  expect_near(tone_mapped(ToneMap::reinhard, glm::vec3(3.0f)), glm::vec3(0.75f));
  // The luminance of (1, 0.5, 0) is 0.2126 + 0.3576.
  expect_near(tone_mapped(ToneMap::reinhard, {1.0f, 0.5f, 0.0f}), {0.63686f, 0.31843f, 0.0f});
}

TEST(ToneMap, AcesIsNarkowiczsFit) {
  // (2.51 + 0.03) / (2.43 + 0.59 + 0.14), and of 0.1: (0.0251 + 0.003) / (0.0243 + 0.059 + 0.14).
  expect_near(tone_mapped(ToneMap::aces, {1.0f, 0.1f, 0.0f}), {0.80380f, 0.12584f, 0.0f});
}

TEST(ToneMap, AgxIsWrenschsFit) {
  expect_near(tone_mapped(ToneMap::agx, glm::vec3(0.18f)), {0.21447f, 0.21453f, 0.21454f});
  expect_near(tone_mapped(ToneMap::agx, {0.5f, 0.25f, 0.1f}), {0.44433f, 0.28059f, 0.14336f});
  // A bright red goes towards white, as none of the others lets it.
  expect_near(tone_mapped(ToneMap::agx, {1.0f, 0.0f, 0.0f}), {0.71942f, 0.03949f, 0.03955f});
}

TEST(ToneMap, EachShowsWhatIsBrightestAndNothingWithinADisplay) {
  for (const ToneMap tone_map : {ToneMap::none, ToneMap::reinhard, ToneMap::aces, ToneMap::agx}) {
    EXPECT_EQ(tone_mapped(tone_map, glm::vec3(0.0f)), glm::vec3(0.0f));
    const glm::vec3 white = tone_mapped(tone_map, glm::vec3(3e38f));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(white[i] > 0.98f && white[i] <= 1.0f) << white[i];
  }
}

TEST(ToneMap, HasAsManyNamesAsOperators) {
  ASSERT_EQ(scene::tone_map_names().size(), 4u);
  EXPECT_EQ(scene::tone_map_names()[static_cast<std::size_t>(ToneMap::agx)], "agx");
}

}  // namespace
}  // namespace airlight::quality
