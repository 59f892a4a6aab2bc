#include "quality/light_texture.h"

#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "quality/image_io.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class LightTextureFile : public testing::Test {
 protected:
  void TearDown() override { fs::remove(file_); }

  Image image_ = {.size = {2, 1}, .channels = {{"R", {1, 2}}, {"G", {3, 4}}, {"B", {5, 0}}}, .metadata = {}};
  const fs::path file_ =
      fs::temp_directory_path() / ("airlight-light-texture-" + std::to_string(getpid()) + ".exr");

  std::string complaint() const {
    try {
      read_light_texture(file_);
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.exit_code, scene::ExitCode::bad_file);
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
      return error.what();
    }
    return "none";
  }
};

TEST_F(LightTextureFile, IsReadRowByRow) {
  image_.channels["Z"] = {7, 7};  // of no use to a light
  write_exr(file_, image_);
  const scene::LightTexture texture = read_light_texture(file_);
  EXPECT_EQ(texture.size(), glm::ivec2(2, 1));
  EXPECT_EQ(texture.texels(), (std::vector<glm::vec3>{{1, 3, 5}, {2, 4, 0}}));
  EXPECT_EQ(texture.name(), file_.string());
}

TEST_F(LightTextureFile, ThatIsNotThereIsNamed) {
  EXPECT_NE(complaint(), "none");
}

TEST_F(LightTextureFile, WithoutAChannelIsRefused) {
  image_.channels.erase("G");
  write_exr(file_, image_);
  EXPECT_THAT(complaint(), HasSubstr("no channel G"));
}

TEST_F(LightTextureFile, WithANegativeValueIsRefused) {
  image_.channels["B"][1] = -0.5f;
  write_exr(file_, image_);
  EXPECT_THAT(complaint(), testing::AllOf(HasSubstr("channel B is -0.5"), HasSubstr("(1, 0)")));
}

TEST(LightTexture, RefusesWhatIsNotFiniteAndNoTexels) {
  const glm::vec3 bad(1, std::numeric_limits<float>::quiet_NaN(), 1);
  EXPECT_THROW(scene::LightTexture("x", {1, 1}, {bad}), scene::Error);
  EXPECT_THROW(scene::LightTexture("x", {0, 1}, {}), scene::Error);
  EXPECT_THROW(scene::LightTexture("x", {1, 1}, {glm::vec3(1.1e6f)}), scene::Error);
}

}  // namespace
}  // namespace airlight::quality
