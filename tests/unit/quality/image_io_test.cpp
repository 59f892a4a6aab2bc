#include "quality/image_io.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "scene/error.h"
#include "support/shared.h"

namespace airlight::quality {
namespace {

/// A file of this test's own, removed when it ends.
class ImageFile : public testing::Test {
 protected:
  ImageFile() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path = std::filesystem::temp_directory_path() / ("airlight_" + std::string(test->name()));
    std::filesystem::remove(path);
  }
  ~ImageFile() override { std::filesystem::remove(path); }

  std::filesystem::path path;
};

/// The message of the scene::Error that f throws.
template <class Function>
std::string error_of(const Function& f) {
  try {
    f();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::bad_file);
    return error.what();
  }
  return "no error";
}

Image small_image() {
  Image image;
  image.size = {3, 2};
  image.channels["R"] = {0, 1, 2, 3, 4, 5};
  image.channels["airlight.G"] = {-1, 1e-30f, 1e30f, 0.1f, 65504, 1e-7f};
  image.channels["distance.Y"] = {6, 7, 8, 9, 10, 11};
  image.metadata["command"] = "airlight render maple.glb -o out.exr";
  return image;
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void overwrite(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

using Exr = ImageFile;
using Png = ImageFile;

TEST_F(Exr, ComesBackBitForBitWithItsMetadata) {
  const Image image = small_image();
  write_exr(path, image);
  const Image back = read_exr(path);
  EXPECT_EQ(back.size, image.size);
  EXPECT_EQ(back.channels, image.channels);
  EXPECT_EQ(back.metadata.at("command"), image.metadata.at("command"));
}

TEST_F(Exr, RefusesToWriteNaNAndInfinityAndSaysWhere) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    Image image = small_image();
    image.channels["airlight.G"][5] = bad;
    const std::string message = error_of([&] { write_exr(path, image); });
    EXPECT_THAT(message, testing::HasSubstr("airlight.G"));
    EXPECT_THAT(message, testing::HasSubstr("(2, 1)"));
    EXPECT_FALSE(std::filesystem::exists(path));
  }
}

TEST_F(Exr, RefusesToReadNaN) {
  // Written as an infinity would be by another program: the bits of a value are replaced in an uncompressed
  // file.
  Image image;
  image.size = {1, 1};
  image.channels["Y"] = {1234.5f};
  write_exr(path, image);  // one value does not compress: its bytes are stored as they are
  std::string bytes = contents(path);
  const float value = 1234.5f, infinity = std::numeric_limits<float>::infinity();
  const std::size_t place = bytes.rfind(std::string(reinterpret_cast<const char*>(&value), 4));
  ASSERT_NE(place, std::string::npos);
  std::memcpy(bytes.data() + place, &infinity, 4);
  overwrite(path, bytes);
  EXPECT_THAT(error_of([&] { read_exr(path); }), testing::HasSubstr("channel Y is inf at pixel (0, 0)"));
}

TEST_F(Exr, SaysWhichFileCannotBeWrittenOrRead) {
  const std::filesystem::path nowhere = path / "missing" / "image.exr";
  EXPECT_THAT(error_of([&] { write_exr(nowhere, small_image()); }), testing::HasSubstr(nowhere.string()));
  EXPECT_THAT(error_of([&] { read_exr(nowhere); }), testing::HasSubstr(nowhere.string()));
  Image empty;
  EXPECT_NE(error_of([&] { write_exr(path, empty); }), "no error");
}

TEST_F(Exr, SurvivesEveryTruncation) {
  write_exr(path, small_image());
  const std::string whole = contents(path);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    overwrite(path, whole.substr(0, length));
    EXPECT_NE(error_of([&] { read_exr(path); }), "no error") << length << " of " << whole.size();
  }
}

TEST_F(Exr, SurvivesEveryBrokenByte) {
  write_exr(path, small_image());
  const std::string whole = contents(path);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (int mask : {0x01, 0x80, 0xff}) {
      std::string broken = whole;
      broken[i] = static_cast<char>(broken[i] ^ mask);
      overwrite(path, broken);
      error_of([&] { read_exr(path); });  // an error or another image, never a crash
    }
  }
}

TEST_F(Exr, RefusesSizesThatItsFileCannotHold) {
  write_exr(path, small_image());
  std::string bytes = contents(path);
  const std::size_t place = bytes.find("dataWindow");
  ASSERT_NE(place, std::string::npos);
  const std::size_t max_x = place + sizeof "dataWindow" + sizeof "box2i" + 4 + 8;
  const std::int32_t huge = 100000;
  std::memcpy(bytes.data() + max_x, &huge, 4);
  std::memcpy(bytes.data() + max_x + 4, &huge, 4);
  overwrite(path, bytes);
  EXPECT_NE(error_of([&] { read_exr(path); }), "no error");
}

TEST_F(Exr, ReadsTheTruthImages) {
  const auto file = airlight::tests::shared_file("truth/cornell_airlight.exr");
  AIRLIGHT_NEEDS(file);
  const Image image = read_exr(file);
  EXPECT_EQ(image.size, glm::ivec2(256, 256));
  for (const char* channel : {"R", "G", "B"}) {
    ASSERT_TRUE(image.channels.contains(channel));
    EXPECT_EQ(image.channels.at(channel).size(), 256u * 256u);
  }
}

/// The 8-bit RGB values of a PNG file.
std::vector<std::uint8_t> read_png(const std::filesystem::path& file, glm::ivec2& size) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> values(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, values.data(), 0, nullptr), 0) << image.message;
  size = glm::ivec2(image.width, image.height);
  return values;
}

TEST_F(Png, EncodesLinearRadianceAsSrgb) {
  // Mid-grey 0.2140411 is 0.5 in sRGB (127.5: either neighbour); 0.001 lies on the linear part:
  // 255·12.92·0.001 = 3.3.
  const std::vector<glm::vec3> radiance{
      {0, 0.5f, 1}, {0.2126f, 0.001f, 0.01f}, {-1, 2, 0.0031308f}, {0.25f, 0.75f, 0.1f}};
  write_png(path, radiance, {2, 2}, 1.0f);
  glm::ivec2 size;
  EXPECT_THAT(read_png(path, size), testing::ElementsAre(0, 188, 255, 127, 3, 25, 0, 255, 10, 137, 225, 89));
  EXPECT_EQ(size, glm::ivec2(2, 2));
}

TEST_F(Png, MultipliesWithTheExposureFirst) {
  const std::vector<glm::vec3> radiance{{0.125f, 0.25f, 1}};
  write_png(path, radiance, {1, 1}, 4.0f);
  glm::ivec2 size;
  EXPECT_THAT(read_png(path, size), testing::ElementsAre(188, 255, 255));
}

TEST_F(Png, RefusesNaNAndSaysWhere) {
  const std::vector<glm::vec3> radiance{
      glm::vec3(0), glm::vec3(0), {0, std::numeric_limits<float>::quiet_NaN(), 0}};
  const std::string message = error_of([&] { write_png(path, radiance, {3, 1}, 1.0f); });
  EXPECT_THAT(message, testing::HasSubstr("channel G"));
  EXPECT_THAT(message, testing::HasSubstr("(2, 0)"));
}

TEST_F(Png, SaysWhichFileCannotBeWritten) {
  const std::filesystem::path nowhere = path / "missing" / "image.png";
  const std::vector<glm::vec3> radiance(1, glm::vec3(0));
  EXPECT_THAT(error_of([&] {
                write_png(nowhere, radiance, {1, 1}, 1.0f);
              }),
              testing::HasSubstr(nowhere.string()));
}

}  // namespace
}  // namespace airlight::quality
