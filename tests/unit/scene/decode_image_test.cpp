#include "scene/decode_image.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/image_files.h"

namespace airlight::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::jpeg_file;
using tests::png_file;
using Texel = glm::u8vec4;

TextureImage decode(std::string_view file) {
  return decode_image({reinterpret_cast<const unsigned char*>(file.data()), file.size()});
}

void expect_broken(std::string_view file, const std::string& text) {
  try {
    decode(file);
    ADD_FAILURE() << "no error; expected one with: " << text;
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(DecodeImage, ReadsAPngAsItIs) {
  const TextureImage image = decode(png_file({2, 2}, tests::k_four_texels));
  EXPECT_EQ(image.size, glm::ivec2(2, 2));
  EXPECT_EQ(image.texels, tests::k_four_texels);
}

TEST(DecodeImage, ReadsPngsOfOtherFormats) {
  EXPECT_THAT(decode(png_file<std::uint8_t>({2, 1}, {0, 77}, PNG_FORMAT_GRAY)).texels,
              ElementsAre(Texel(0, 0, 0, 255), Texel(77, 77, 77, 255)));
  EXPECT_THAT(decode(png_file<std::uint8_t>({1, 1}, {10, 20, 30}, PNG_FORMAT_RGB)).texels,
              ElementsAre(Texel(10, 20, 30, 255)));
}

/// PNG's own bytes of 16 bits are sRGB in glTF, too, though libpng takes them for linear unless told.
TEST(DecodeImage, TakesSixteenBitsForSrgb) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::string file;
  png_set_write_fn(
      png, &file,
      [](png_structp p, png_bytep bytes, png_size_t count) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(bytes), count);
      },
      nullptr);
  png_set_IHDR(png, info, 1, 1, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::vector<unsigned char> row = {100, 100};
  png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  EXPECT_THAT(decode(file).texels, ElementsAre(Texel(100, 100, 100, 255)));
}

TEST(DecodeImage, ReadsAJpegToItsOwnError) {
  const std::vector<glm::u8vec3> texels(8 * 3, glm::u8vec3(200, 100, 50));
  const TextureImage image = decode(jpeg_file({8, 3}, texels));
  EXPECT_EQ(image.size, glm::ivec2(8, 3));
  ASSERT_EQ(image.texels.size(), 24u);
  for (const Texel& texel : image.texels) {
    // YCbCr in 8 bits.
    EXPECT_NEAR(texel.r, 200, 2);
    EXPECT_NEAR(texel.g, 100, 2);
    EXPECT_NEAR(texel.b, 50, 2);
    EXPECT_EQ(texel.a, 255);
  }
}

TEST(DecodeImage, ReadsASingleTexel) {
  EXPECT_THAT(decode(png_file<Texel>({1, 1}, {{1, 2, 3, 4}})).texels, ElementsAre(Texel(1, 2, 3, 4)));
  EXPECT_EQ(decode(jpeg_file({1, 1}, {{0, 0, 0}})).texels.size(), 1u);
}

TEST(DecodeImage, RefusesWhatIsNoImage) {
  expect_broken("", "it is empty");
  expect_broken("GIF89a", "neither PNG nor JPEG");
  expect_broken("\x89PN", "neither PNG nor JPEG");
}

TEST(DecodeImage, RefusesBrokenFilesWhereverTheyEnd) {
  const std::vector<glm::u8vec4> noise = [] {
    std::vector<glm::u8vec4> texels;
    for (unsigned i = 0; i < 32 * 32; ++i) texels.emplace_back(i * 37 % 256, i * 91 % 256, i * 13 % 256, 255);
    return texels;
  }();
  std::string png = png_file({32, 32}, noise);
  for (std::size_t size = 4; size + 12 < png.size(); size += 97)  // what follows is the chunk that ends it
    expect_broken(png.substr(0, size), "it is a broken PNG");
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x55);
  expect_broken(png, "it is a broken PNG");

  std::vector<glm::u8vec3> colours(noise.begin(), noise.end());
  const std::string jpeg = jpeg_file({32, 32}, colours);
  for (std::size_t size = 2; size + 100 < jpeg.size(); size += 97)
    expect_broken(jpeg.substr(0, size), "it is a broken JPEG");
}

TEST(DecodeImage, RefusesWhatIsLargerThanEveryDriverTakes) {
  expect_broken(png_file({k_largest_texture + 1, 1}, std::vector<Texel>(k_largest_texture + 1)), "16385x1");
  expect_broken(jpeg_file({1, k_largest_texture + 1}, std::vector<glm::u8vec3>(k_largest_texture + 1)),
                "1x16385");
}

TEST(DecodeImage, RefusesAPngOfNoSize) {
  std::string png = png_file({2, 2}, tests::k_four_texels);
  png.replace(16, 4, 4, '\0');  // the width in its header
  expect_broken(png, "it is a broken PNG");
}

}  // namespace
}  // namespace airlight::scene
