#include "quality/truth_sample.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "quality/metrics.h"
#include "reference/reference.h"
#include "support/scenes.h"

namespace airlight::quality {
namespace {

TEST(TileDraw, DrawsEachTileAsOftenAsItsWeightSays) {
  const glm::ivec2 size(60, 33);  // the last tiles are cut
  std::vector<glm::vec3> a(60 * 33), b(60 * 33);
  for (std::size_t i = 0; i < 500; ++i) b[i] = glm::vec3(0.1f * static_cast<float>(i % 7));
  const TileDraw draw(size, std::array{a, b});
  ASSERT_EQ(draw.tiles(), 8u * 5u);
  std::vector<double> sum(draw.tiles());
  constexpr int k_seeds = 20000;
  for (int seed = 0; seed < k_seeds; ++seed) {
    const auto drawn = draw.drawn(12, static_cast<std::uint32_t>(seed));
    EXPECT_EQ(drawn.size(), 12u);
    for (const DrawnTile& tile : drawn)
      sum[static_cast<std::size_t>(8 * tile.tile.y + tile.tile.x)] += tile.weight;
  }
  // So that the sum over drawn tiles of weight times anything is, on average, its sum over all tiles.
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i] / k_seeds, 1.0, 0.15) << i;
  // Those that differ are drawn more often.
  const auto drawn = draw.drawn(12, 1);
  EXPECT_GT(std::count_if(drawn.begin(), drawn.end(), [](const DrawnTile& tile) { return tile.tile.y <= 1; }),
            6);
}

TEST(TileDraw, IsNotMadeBlindByAnImageThatIsWrongEverywhere) {
  const glm::ivec2 size(80, 80);
  std::vector<std::vector<glm::vec3>> images(5, std::vector<glm::vec3>(80 * 80, glm::vec3(1.0f)));
  for (std::size_t i = 0; i < images[0].size(); ++i)
    images[0][i] = glm::vec3(static_cast<float>(i % 9) * 100.0f);
  for (std::size_t x = 40; x < 48; ++x)
    images[2][80 * 20 + x] = glm::vec3(1.01f);  // of one tile, a little off
  const auto drawn = TileDraw(size, images).drawn(20, 1);
  EXPECT_GT(std::count_if(drawn.begin(), drawn.end(),
                          [](const DrawnTile& tile) { return tile.tile == glm::ivec2(5, 2); }),
            5);
}

class ErrorOfCornell : public testing::Test {
 protected:
  static std::vector<DrawnTile> every_tile() {
    std::vector<DrawnTile> tiles;
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) tiles.push_back({{x, y}, 1.0});
    return tiles;
  }

  ErrorOfCornell() {
    images_.size = view_.size;
    images_.distance = truth_.distance();
    images_.airlight = truth_.airlight();
    // Wrong in one place, and where the surface is another.
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 48; ++x)
        images_.airlight[static_cast<std::size_t>(48 * y + x)] *= 1.0f + 0.01f * static_cast<float>(x % 5);
    images_.distance[100] *= 2.0f;
    images_.airlight[100] = glm::vec3(1000.0f);
  }

  double whole() const {
    return same_surface_error(channels_of(images_.airlight), images_.distance, channels_of(truth_.airlight()),
                              truth_.distance())
        .rrmse;
  }

  const scene::Scene& scene_ = tests::builtin("cornell");
  scene::View view_ = tests::view_of(scene_, {48, 48});
  TruthOfTiles truth_{scene_.geometry, view_, every_tile()};
  frame::FrameImages images_;
};

TEST_F(ErrorOfCornell, TruthIsThatOfTheWholeImage) {
  EXPECT_EQ(truth_.airlight(), reference::Reference(scene_.geometry, view_).exact().radiance);
}

TEST_F(ErrorOfCornell, IsThatOfTheWholeImageWhereAllTilesAreDrawn) {
  const TileDraw draw(view_.size, std::array{truth_.airlight(), truth_.airlight()});
  const std::vector<DrawnTile> all = draw.drawn(draw.tiles(), 1);
  EXPECT_EQ(TruthOfTiles(scene_.geometry, view_, all).pixels(), 48u * 48u);
  ErrorOfTiles error;
  error.add(truth_, all, images_);
  EXPECT_NEAR(error.rrmse(), whole(), 1e-9 * whole());
}

TEST_F(ErrorOfCornell, IsFoundWithFewTilesWhereTheErrorLies) {
  std::vector<glm::vec3> other = truth_.airlight();
  for (std::size_t i = 0; i < 12 * 48; ++i) other[i] *= 0.98f;
  const TileDraw draw(view_.size, std::array{truth_.airlight(), other});
  double mean = 0.0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const std::vector<DrawnTile> drawn = draw.drawn(12, seed);
    const TruthOfTiles few(scene_.geometry, view_, drawn);
    EXPECT_LE(few.pixels(), 12u * 64u);
    ErrorOfTiles error;
    error.add(few, drawn, images_);
    mean += error.rrmse() / 20;
    EXPECT_EQ(error.part_not_above(10.0 * whole()), 1.0);
    EXPECT_EQ(error.part_not_above(0.1 * whole()), 0.0);
  }
  EXPECT_NEAR(mean, whole(), 0.1 * whole());
}

}  // namespace
}  // namespace airlight::quality
