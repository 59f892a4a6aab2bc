#include "frame/texture_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace airlight::frame {
namespace {

using testing::ElementsAre;
using Texel = glm::u8vec4;

constexpr Texel k_black(0, 0, 0, 255), k_white(255, 255, 255, 255);

TEST(NextLevel, AveragesInLinearLight) {
  const scene::TextureImage level = next_level({{2, 2}, {k_black, k_white, k_white, k_black}});
  EXPECT_EQ(level.size, glm::ivec2(1, 1));
  // Half the light is 0.7354 in sRGB, not 0.5.
  EXPECT_THAT(level.texels, ElementsAre(Texel(188, 188, 188, 255)));
}

TEST(NextLevel, AveragesAlphaAsItIs) {
  EXPECT_THAT(next_level({{2, 1}, {Texel(9, 9, 9, 100), Texel(9, 9, 9, 201)}}).texels,
              ElementsAre(Texel(9, 9, 9, 151)));
}

TEST(NextLevel, GivesEachTexelOfAnOddSideItsPart) {
  // 0.4, 0.4 and 0.2 of five texels, of which the middle one alone is white, on either side: sRGB of 0.2.
  EXPECT_THAT(next_level({{5, 1}, {k_black, k_black, k_white, k_black, k_black}}).texels,
              ElementsAre(Texel(124, 124, 124, 255), Texel(124, 124, 124, 255)));
  // The same upright, and of the first texel alone: 0.4.
  EXPECT_THAT(next_level({{1, 5}, {k_white, k_black, k_black, k_black, k_black}}).texels,
              ElementsAre(Texel(170, 170, 170, 255), k_black));
  // A third each.
  EXPECT_THAT(next_level({{3, 1}, {k_white, k_black, k_black}}).texels,
              ElementsAre(Texel(156, 156, 156, 255)));
}

TEST(NextLevel, HalvesEachSideByItself) {
  EXPECT_EQ(next_level({{8, 1}, std::vector<Texel>(8, k_white)}).size, glm::ivec2(4, 1));
  const scene::TextureImage level = next_level({{1, 7}, std::vector<Texel>(7, k_white)});
  EXPECT_EQ(level.size, glm::ivec2(1, 3));
  EXPECT_THAT(level.texels, ElementsAre(k_white, k_white, k_white));
}

}  // namespace
}  // namespace airlight::frame
