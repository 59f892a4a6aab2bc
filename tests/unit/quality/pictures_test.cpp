#include "quality/pictures.h"

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace airlight::quality {
namespace {

TEST(AutomaticExposure, MapsThe95thPercentileToFourFifths) {
  std::vector<glm::vec3> radiance;
  for (int i = 1; i <= 101; ++i) radiance.emplace_back(0.0f, static_cast<float>(i), 0.5f);
  EXPECT_FLOAT_EQ(automatic_exposure(radiance), 0.8f / 96.0f);
}

TEST(AutomaticExposure, IsDefinedForDarkImages) {
  std::vector<glm::vec3> radiance(100, glm::vec3(0.0f));
  EXPECT_EQ(automatic_exposure(radiance), 1.0f);
  radiance[3].x = 2.0f;
  EXPECT_FLOAT_EQ(automatic_exposure(radiance), 0.4f);
  EXPECT_EQ(automatic_exposure({}), 1.0f);
}

TEST(ErrorColours, AreWhiteForSmallErrorsAndTellTheSignOfLargeOnes) {
  const std::vector<glm::vec3> reference(4, glm::vec3(2.0f));
  std::vector<glm::vec3> image = reference;
  image[1] += 0.001f;  // relative to the mean of 2: 5e-4
  image[2] += 2.0f;
  image[3] -= 2.0f;
  const std::vector<glm::vec3> colours = error_colours(image, reference);
  EXPECT_EQ(colours[0], glm::vec3(1.0f));
  EXPECT_EQ(colours[1], glm::vec3(1.0f));
  EXPECT_GT(colours[2].r, 5.0f * colours[2].b);
  EXPECT_GT(colours[3].b, 5.0f * colours[3].r);
}

TEST(ErrorColours, DeepenByDecade) {
  const std::vector<glm::vec3> reference(3, glm::vec3(1.0f));
  const std::vector<glm::vec3> colours =
      error_colours({glm::vec3(1.01f), glm::vec3(1.1f), glm::vec3(2.0f)}, reference);
  const float first = 1.0f - colours[0].g, second = 1.0f - colours[1].g, third = 1.0f - colours[2].g;
  EXPECT_NEAR(second / first, 2.0f, 1e-3f);
  EXPECT_NEAR(third / first, 3.0f, 1e-3f);
}

TEST(ErrorColours, AreFullAgainstABlackReference) {
  const std::vector<glm::vec3> black(1, glm::vec3(0.0f));
  EXPECT_EQ(error_colours(black, black)[0], glm::vec3(1.0f));
  EXPECT_EQ(error_colours({glm::vec3(1e-6f)}, black)[0].g, 0.0f);
}

TEST(SurfaceColours, MarkWrongAndUndecidedPixels) {
  using reference::Verdict;
  const reference::SurfaceVerdict lit{Verdict::lit, true}, dark{Verdict::dark, true},
      undecided{Verdict::dark, false};
  frame::FrameImages images;
  images.size = {3, 2};
  images.distance = {1, 1, 1, 1, 1, 0};
  images.visibility = {{1, 0, 1, 0, 1, 0}};
  images.is_skipped = {false};
  const std::vector<glm::vec3> colours =
      surface_colours(images, {{lit, dark, dark, lit, undecided, std::nullopt}});
  const auto is_grey = [](const glm::vec3& colour) { return colour.r == colour.g && colour.g == colour.b; };
  EXPECT_TRUE(is_grey(colours[0]) && is_grey(colours[1]));
  EXPECT_GT(colours[0].r, colours[1].r);
  EXPECT_GT(colours[1].r, 0.0f) << "a surface in shadow is told from none";
  const glm::vec3 red = colours[2], yellow = colours[4];
  EXPECT_GT(red.r, red.g);
  EXPECT_EQ(colours[3], red);
  EXPECT_GT(yellow.g, yellow.b);
  EXPECT_GT(yellow.g, red.g);
  EXPECT_EQ(colours[5], glm::vec3(0.0f));

  // Of several lights what is wrong for one is red; one that was skipped does not count.
  images.visibility.push_back(std::vector<float>(6, 0.0f));
  images.is_skipped.push_back(false);
  const std::vector<SurfaceVerdicts> both = {{lit, dark, lit, lit, undecided, std::nullopt},
                                             {undecided, dark, dark, dark, lit, std::nullopt}};
  const std::vector<glm::vec3> of_both = surface_colours(images, both);
  EXPECT_EQ(of_both[0], yellow);
  EXPECT_EQ(of_both[1], colours[1]);
  EXPECT_FLOAT_EQ(of_both[2].r, 0.5f * (colours[0].r + colours[1].r));
  EXPECT_EQ(of_both[3], red);
  EXPECT_EQ(of_both[4], red);
  images.is_skipped[1] = true;
  EXPECT_EQ(surface_colours(images, both)[0], colours[0]);
  EXPECT_EQ(surface_colours(images, both)[4], yellow);
}

TEST(Frame, HasItsChannelsInAFile) {
  frame::FrameImages images;
  images.size = {1, 1};
  images.radiance = {{1, 2, 3}};
  images.airlight = {{4, 5, 6}};
  images.visibility = {{1}};
  images.distance = {7};
  const auto file = std::filesystem::temp_directory_path() / fmt::format("airlight-frame-{}.exr", getpid());
  write_frame(file, images, {{"airlight.scene", "hall"}});
  const Image image = read_exr(file);
  std::filesystem::remove(file);
  EXPECT_EQ(image.channels.at("B"), std::vector<float>{3});
  EXPECT_EQ(image.channels.at("airlight.R"), std::vector<float>{4});
  EXPECT_EQ(image.channels.at("surface.Y"), std::vector<float>{1});
  EXPECT_EQ(image.channels.at("distance.Y"), std::vector<float>{7});
  EXPECT_EQ(image.metadata.at("airlight.scene"), "hall");
}

TEST(Frame, OfSeveralLightsHasChannelsOfEach) {
  frame::FrameImages images;
  images.size = {1, 1};
  images.radiance = {{1, 2, 3}};
  images.airlight = {{4, 5, 6}};
  images.lights = {"lamp.001", "light1"};
  images.is_skipped = {false, true};
  images.airlight_of_light = {{{4, 5, 6}}, {{0, 0, 0}}};
  images.visibility = {{1}, {0}};
  images.distance = {7};
  const auto file = std::filesystem::temp_directory_path() / fmt::format("airlight-lights-{}.exr", getpid());
  write_frame(file, images, {});
  const Image image = read_exr(file);
  std::filesystem::remove(file);
  EXPECT_EQ(image.channels.size(), 3u + 3u + 2u + 2 * 4u);
  EXPECT_EQ(image.channels.at("airlight.lamp.001.G"), std::vector<float>{5});
  EXPECT_EQ(image.channels.at("airlight.light1.G"), std::vector<float>{0});
  EXPECT_EQ(image.channels.at("surface.lamp.001.Y"), std::vector<float>{1});
  EXPECT_EQ(image.channels.at("surface.light1.Y"), std::vector<float>{0});
  EXPECT_EQ(image.channels.at("surface.Y"), std::vector<float>{0.5f});
  EXPECT_EQ(image.metadata.at("airlight.skipped-lights"), "light1");
}

}  // namespace
}  // namespace airlight::quality
