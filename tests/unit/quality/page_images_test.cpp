#include "quality/page_images.h"

#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "quality/image_io.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(WorstCrops, BeginWithTheMostErrorAndDoNotOverlap) {
  GreyPixels error{{32, 16}, std::vector<float>(32 * 16, 0.0f)};
  const auto at = [&](int x, int y) -> float& { return error.values[static_cast<std::size_t>(32 * y + x)]; };
  at(20, 10) = 5.0f;
  at(21, 10) = 4.0f;
  at(3, 2) = 6.0f;
  const std::vector<Crop> crops = worst_crops(error, {8, 8}, 3);
  ASSERT_EQ(crops.size(), 3u);
  const auto holds = [](const Crop& crop, int x, int y) {
    return x >= crop.from.x && x < crop.from.x + 8 && y >= crop.from.y && y < crop.from.y + 8;
  };
  EXPECT_TRUE(holds(crops[0], 20, 10) && holds(crops[0], 21, 10));
  EXPECT_TRUE(holds(crops[1], 3, 2));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_TRUE(std::abs(crops[i].from.x - crops[k].from.x) >= 8 ||
                  std::abs(crops[i].from.y - crops[k].from.y) >= 8);
  EXPECT_EQ(worst_crops(error, {32, 16}, 3).size(), 1u) << "there is room for one alone";
}

/// A comparison of runs with images of noise, which nothing makes small.
class ImagesOfAPage : public testing::Test {
 protected:
  static constexpr glm::ivec2 k_size{64, 48};

  ImagesOfAPage() {
    std::filesystem::create_directories(folder_);
    joined_.truth = folder_ / "reference";
    joined_.comparison = {{"reference", {{"floor", 0.0}}}};
    write("reference");
    for (int i = 0; i < 5; ++i) {
      JoinedRun run;
      run.image = folder_ / fmt::format("run{}", i);
      write(fmt::format("run{}", i));
      joined_.runs.push_back(run);
    }
  }
  ~ImagesOfAPage() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, glm::ivec2 size = k_size) {
    Image image{.size = size, .channels = {}, .metadata = {}};
    std::uniform_real_distribution<float> noise(0.5f, 1.0f);
    for (const char* channel : {"airlight.R", "airlight.G", "airlight.B", "distance.Y"})
      for (int i = 0; i < size.x * size.y; ++i)
        image.channels[channel].push_back(channel[0] == 'd' ? 1.0f : noise(random_));
    write_exr(folder_ / (name + ".exr"), image);
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-page-images-{}", getpid());
  JoinedRuns joined_;
  std::mt19937 random_{1};
};

TEST_F(ImagesOfAPage, AreWholeForTheFirstRunsAndCropsForTheOthers) {
  const PageImages page = page_images(joined_, 3, 1'000'000);
  EXPECT_EQ(page.problem, "");
  EXPECT_EQ(page.json["reduced"], 1);
  EXPECT_EQ(page.json["crops"].size(), 3u);
  EXPECT_NEAR(page.json["mean"].get<double>(), 0.75, 0.01);
  EXPECT_TRUE(page.json["truth"].contains("whole"));
  const auto& runs = page.json["runs"];
  ASSERT_EQ(runs.size(), 5u);
  for (const char* run : {"0", "1"}) {
    EXPECT_EQ(runs[run]["whole"]["width"], 64);
    EXPECT_TRUE(runs[run].contains("flip"));
    EXPECT_FALSE(runs[run].contains("crops")) << "they are cut out of the whole image";
  }
  for (const char* run : {"2", "3", "4"}) {
    EXPECT_FALSE(runs[run].contains("whole"));
    EXPECT_EQ(runs[run]["crops"].size(), 3u);
    EXPECT_EQ(runs[run]["crops"][0]["width"], 16);
    EXPECT_EQ(runs[run]["flip_crops"].size(), 3u);
  }
  for (const auto& [run, source] : runs.items())
    for (const auto& [kind, kept] : source.items())
      EXPECT_THAT(page.html, HasSubstr(fmt::format(
                                 "id=\"{}\"", (kept.is_array() ? kept[0] : kept)["id"].get<std::string>())));
}

TEST_F(ImagesOfAPage, AreReducedUntilTheyFit) {
  const PageImages all = page_images(joined_, 3, 1'000'000);
  const std::size_t budget = all.html.size() - 1;
  const PageImages page = page_images(joined_, 3, budget);
  EXPECT_LE(page.html.size(), budget);
  EXPECT_EQ(page.json["reduced"], 2);
  EXPECT_EQ(page.json["truth"]["whole"]["width"], 32);
  EXPECT_EQ(page.json["runs"]["0"]["whole"]["height"], 24);
  EXPECT_EQ(page.json["runs"]["0"]["crops"].size(), 3u) << "with all pixels";
  EXPECT_EQ(page.json["truth"]["crops"].size(), 3u);
  for (const std::size_t less : {10'000u, 30'000u, 60'000u})
    EXPECT_LE(page_images(joined_, 3, less).html.size(), less);
}

TEST_F(ImagesOfAPage, AreLeftOutWhereThereIsNoRoom) {
  const PageImages some = page_images(joined_, 2, 40'000);
  EXPECT_GT(some.json["without"], 0);
  const PageImages none = page_images(joined_, 3, 100);
  EXPECT_TRUE(none.json.is_null());
  EXPECT_THAT(none.problem, HasSubstr("no room"));
}

TEST_F(ImagesOfAPage, ThatAreMissingAreNoError) {
  std::filesystem::remove(folder_ / "run0.exr");
  EXPECT_FALSE(page_images(joined_, 3, 1'000'000).json["runs"].contains("0"));
  std::filesystem::remove(folder_ / "reference.exr");
  EXPECT_THAT(page_images(joined_, 3, 1'000'000).problem, HasSubstr("no longer lies beside"));
  joined_.truth.clear();
  EXPECT_THAT(page_images(joined_, 3, 1'000'000).problem, HasSubstr("A sweep keeps no images"));
}

TEST_F(ImagesOfAPage, OfAnotherSizeAreErrors) {
  write("run1", {32, 32});
  try {
    page_images(joined_, 8, 1'000'000);
    ADD_FAILURE();
  } catch (const scene::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("run1.exr: it is not of the size"));
  }
}

}  // namespace
}  // namespace airlight::quality
