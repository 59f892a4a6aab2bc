#include "quality/packed_image.h"

#include <cmath>
#include <cstdint>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>
#include <glm/gtc/packing.hpp>

namespace airlight::quality {
namespace {

std::string bytes_of_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(word >> bits & 255u);
  }
  return bytes;
}

std::vector<std::uint8_t> inflated(const std::string& text, std::size_t size) {
  const std::string bytes = bytes_of_base64(text);
  std::vector<std::uint8_t> result(size);
  uLongf length = size;
  EXPECT_EQ(uncompress(result.data(), &length, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  EXPECT_EQ(length, size);
  return result;
}

/// What quality/page/images.js makes of it.
RgbPixels unpacked(const std::string& text, glm::ivec2 size) {
  const auto pixels = static_cast<std::size_t>(size.x * size.y);
  const std::vector<std::uint8_t> bytes = inflated(text, 6 * pixels);
  std::vector<std::uint16_t> planes;
  for (std::size_t i = 0; i < 3 * pixels; ++i) {
    const unsigned before = i % pixels == 0 ? 0u : planes.back();
    planes.push_back(static_cast<std::uint16_t>(before + bytes[i] + 256u * bytes[3 * pixels + i]));
  }
  RgbPixels image{size, {}};
  const auto value = [](unsigned bits) { return glm::unpackHalf1x16(static_cast<std::uint16_t>(bits)); };
  for (std::size_t i = 0; i < pixels; ++i) {
    const unsigned g = planes[i], r = planes[pixels + i] + g, b = planes[2 * pixels + i] + g;
    image.values.emplace_back(value(r), value(g), value(b));
  }
  return image;
}

TEST(Base64, IsThatOfTheStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(PackedRgb, KeepsHalfFloats) {
  constexpr float k_unit = 0.25f;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-20.0f, 12.0f);
  RgbPixels image{{17, 9}, {}};
  for (int i = 0; i < 17 * 9; ++i)
    image.values.emplace_back(std::exp2(exponent(random)), std::exp2(exponent(random)),
                              i % 5 == 0 ? 0.0f : 3.0f);
  const RgbPixels back = unpacked(packed(image, k_unit), image.size);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    for (int channel = 0; channel < 3; ++channel) {
      const float value = image.values[i][channel] / k_unit;
      // Eleven digits, or of the smallest a multiple of 2^-24.
      EXPECT_NEAR(back.values[i][channel], value, std::max(value * 0x1p-11f, 0x1p-25f)) << i;
    }
}

TEST(PackedRgb, CutsWhatIsMoreThanTheLargestHalf) {
  const RgbPixels back = unpacked(packed({{1, 1}, {{1e9f, 65504.0f, -1e9f}}}, 1.0f), {1, 1});
  EXPECT_EQ(back.values[0], glm::vec3(65504.0f, 65504.0f, -65504.0f));
}

TEST(PackedRgb, FindsWhatIsAlike) {
  RgbPixels grey{{64, 64}, {}}, coloured = grey;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> noise(0.5f, 1.0f);
  for (int i = 0; i < 64 * 64; ++i) {
    const float value = noise(random);
    grey.values.emplace_back(value);
    coloured.values.emplace_back(value, noise(random), noise(random));
  }
  EXPECT_LT(packed(grey, 1.0f).size(), 0.4 * static_cast<double>(packed(coloured, 1.0f).size()));
}

TEST(PackedGrey, KeepsEightBits) {
  const GreyPixels image{{5, 1}, {0.0f, 1.0f, 0.5f, 2.0f, -1.0f}};
  const std::vector<std::uint8_t> bytes = inflated(packed(image), 5);
  std::vector<int> values;
  for (const std::uint8_t difference : bytes)
    values.push_back(((values.empty() ? 0 : values.back()) + difference) % 256);
  EXPECT_THAT(values, testing::ElementsAre(0, 255, 128, 255, 0));
}

TEST(Reduced, IsMeansOfWhatThereIs) {
  const GreyPixels image{{3, 3}, {1.0f, 3.0f, 5.0f, 5.0f, 7.0f, 9.0f, 2.0f, 4.0f, 8.0f}};
  const GreyPixels small = reduced(image, 2);
  EXPECT_EQ(small.size, glm::ivec2(2, 2));
  EXPECT_THAT(small.values, testing::ElementsAre(4.0f, 7.0f, 3.0f, 8.0f));
  EXPECT_EQ(reduced(image, 1).values, image.values);
}

TEST(PartOf, IsCutOut) {
  const GreyPixels image{{3, 2}, {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f}};
  EXPECT_THAT(part_of(image, {{1, 0}, {2, 2}}).values, testing::ElementsAre(2.0f, 3.0f, 5.0f, 6.0f));
}

}  // namespace
}  // namespace airlight::quality
