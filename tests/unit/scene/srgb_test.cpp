#include "scene/srgb.h"

#include <gtest/gtest.h>

namespace airlight::scene {
namespace {

TEST(Srgb, DecodesByItsDefinition) {
  EXPECT_EQ(linear_from_srgb(0.0), 0.0);
  EXPECT_DOUBLE_EQ(linear_from_srgb(1.0), 1.0);
  EXPECT_DOUBLE_EQ(linear_from_srgb(0.04045), 0.04045 / 12.92);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114, 1e-8);  // ((0.5 + 0.055) / 1.055)^2.4
}

TEST(Srgb, EncodesEachByteAsItWasDecoded) {
  const SrgbEncoder encode;
  for (int byte = 0; byte < 256; ++byte)
    EXPECT_EQ(encode(static_cast<float>(linear_from_srgb(byte / 255.0))), byte);
  EXPECT_EQ(encode(-1.0f), 0);
  EXPECT_EQ(encode(7.0f), 255);
}

}  // namespace
}  // namespace airlight::scene
