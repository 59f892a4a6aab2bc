#include "quality/image_pair.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/error.h"

namespace airlight::quality {
namespace {

using testing::HasSubstr;

/// 2×1 pixels. @param grey of R, G and B
ImageFile grey_image(const char* name, float left, float right) {
  ImageFile file{name, {}};
  file.image.size = {2, 1};
  for (const char* channel : {"R", "G", "B"}) file.image.channels[channel] = {left, right};
  return file;
}

template <typename Function>
std::string problem_of(scene::ExitCode code, const Function& function) {
  try {
    function();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, code);
    return error.what();
  }
  return "no error";
}

TEST(ImagePair, IsMeasuredByHand) {
  // x − r = 1, 0 with a mean of r of 2.
  const PairError error = pair_error(grey_image("x", 2, 3), grey_image("r", 1, 3), "");
  EXPECT_NEAR(error.all.bias, 0.25, 1e-12);
  EXPECT_NEAR(error.all.rmse, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(error.all.rrmse, std::sqrt(0.5) / 2.0, 1e-12);
  EXPECT_NEAR(error.all.max, 0.5, 1e-12);
  EXPECT_GT(error.flip, 0.0);
  EXPECT_FALSE(error.same_surface);

  const auto json = nlohmann::json::parse(pair_error_json(error));
  EXPECT_NEAR(json["airlight"]["rrmse"].get<double>(), std::sqrt(0.5) / 2.0, 1e-12);
  EXPECT_FALSE(json.contains("airlight_same_surface"));
  EXPECT_THAT(pair_error_text(error), HasSubstr("rrmse"));
}

TEST(ImagePair, LeavesOutWhatShowsAnotherSurfaceWhereDistancesTell) {
  ImageFile x = grey_image("x", 2, 3), r = grey_image("r", 1, 3);
  x.image.channels["distance.Y"] = {5, 7};
  r.image.channels["distance.Y"] = {6, 7};
  const PairError error = pair_error(x, r, "");
  ASSERT_TRUE(error.same_surface);
  EXPECT_EQ(error.same_surface->left_out_pixels, 1u);
  EXPECT_EQ(error.same_surface->rrmse, 0.0);
  EXPECT_TRUE(nlohmann::json::parse(pair_error_json(error)).contains("airlight_same_surface"));
}

TEST(ImagePair, TakesALayerOrOneChannelInGrey) {
  ImageFile image = grey_image("x.exr", 1, 2);
  for (const char* channel : {"airlight.R", "airlight.G", "airlight.B"})
    image.image.channels[channel] = {3, 4};
  image.image.channels["surface.Y"] = {0, 1};
  EXPECT_EQ(layer_of(image, "")[1], glm::vec3(2));
  EXPECT_EQ(layer_of(image, "airlight")[1], glm::vec3(4));
  EXPECT_EQ(layer_of(image, "surface")[1], glm::vec3(1));
  EXPECT_THAT(problem_of(scene::ExitCode::bad_file, [&] { layer_of(image, "glow"); }),
              testing::AllOf(HasSubstr("x.exr: it has no channel glow.R"), HasSubstr("surface.Y")));
}

TEST(ImagePair, IsRefusedWhereSizesDifferOrAValueIsNone) {
  ImageFile wide = grey_image("wide.exr", 1, 2);
  wide.image.size = {1, 2};
  EXPECT_THAT(problem_of(scene::ExitCode::bad_file, [&] { pair_error(wide, grey_image("r.exr", 1, 2), ""); }),
              HasSubstr("wide.exr: it has 1x2 pixels, r.exr has 2x1"));
  EXPECT_THAT(problem_of(scene::ExitCode::bad_file,
                         [&] {
                           pair_error(grey_image("x.exr", 1, std::numeric_limits<float>::quiet_NaN()),
                                      grey_image("r.exr", 1, 2), "");
                         }),
              testing::Not("no error"));
}

TEST(Difference, IsOfTheChannelsThatBothHave) {
  ImageFile x = grey_image("x", 2, 3), r = grey_image("r", 1, 5);
  x.image.channels["distance.Y"] = {1, 1};
  const Image difference = quality::difference(x, r);
  EXPECT_EQ(difference.channels.size(), 3u);
  EXPECT_EQ(difference.channels.at("G"), (std::vector<float>{1, -2}));
  r.image.channels = {{"depth", {0, 0}}};
  EXPECT_THAT(problem_of(scene::ExitCode::bad_file, [&] { quality::difference(x, r); }),
              HasSubstr("no channel in common"));
}

TEST(Crop, IsAPartOfEveryChannel) {
  ImageFile image{"x.exr", {}};
  image.image.size = {3, 2};
  image.image.channels["Y"] = {0, 1, 2, 3, 4, 5};
  image.image.metadata["note"] = "kept";
  const Image part = cropped(image, {{1, 0}, {2, 2}});
  EXPECT_EQ(part.size, glm::ivec2(2, 2));
  EXPECT_EQ(part.channels.at("Y"), (std::vector<float>{1, 2, 4, 5}));
  EXPECT_EQ(part.metadata.at("note"), "kept");
  for (const Crop& outside : {Crop{{2, 0}, {2, 1}}, Crop{{0, 1}, {1, 2}}, Crop{{-1, 0}, {1, 1}},
                              Crop{{0, 0}, {0, 1}}, Crop{{1, 0}, {std::numeric_limits<int>::max(), 1}}})
    EXPECT_THAT(problem_of(scene::ExitCode::usage, [&] { cropped(image, outside); }),
                HasSubstr("do not lie in"));
}

TEST(ImageInfo, TellsTheRangeOfWhatIsFinite) {
  ImageFile image = grey_image("x", 1, std::numeric_limits<float>::infinity());
  image.image.metadata["airlight.scene"] = "window";
  const std::string info = image_info(image);
  EXPECT_THAT(info, HasSubstr("2x1 pixels\nairlight.scene: window\n"));
  EXPECT_THAT(info, testing::ContainsRegex("R +1 +1 +1 +1\n"));
}

}  // namespace
}  // namespace airlight::quality
