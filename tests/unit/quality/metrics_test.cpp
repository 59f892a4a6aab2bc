#include "quality/metrics.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "scene/error.h"

namespace airlight::quality {
namespace {

TEST(AirlightError, MatchesTwoByTwoImagesWorkedOutByHand) {
  // Mean of r: 2. Differences: 1, 0, 0, −2.
  const std::vector<float> r{1, 1, 2, 4}, x{2, 1, 2, 2};
  const AirlightError error = airlight_error(x, r);
  EXPECT_DOUBLE_EQ(error.bias, 7.0 / 8.0 - 1.0);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt(5.0 / 4.0));
  EXPECT_DOUBLE_EQ(error.rrmse, std::sqrt(5.0 / 4.0) / 2.0);
  EXPECT_DOUBLE_EQ(error.mae, 0.75 / 2.0);
  EXPECT_DOUBLE_EQ(error.p99, 1.0);
  EXPECT_DOUBLE_EQ(error.max, 1.0);
  // ε = 1e-2 · 2² = 0.04.
  EXPECT_DOUBLE_EQ(error.relmse, (1.0 / 1.04 + 4.0 / 16.04) / 4.0);
  EXPECT_DOUBLE_EQ(error.leaked, 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(error.spurious, 2.0 / 8.0);
}

TEST(AirlightError, IsTakenFromTheReference) {
  const std::vector<float> a{1, 1, 2, 4}, b{2, 1, 2, 2};
  EXPECT_DOUBLE_EQ(airlight_error(b, a).bias, -0.125);
  EXPECT_DOUBLE_EQ(airlight_error(a, b).bias, 1.0 / 7.0);
}

TEST(AirlightError, OfEqualImagesIsZero) {
  const std::vector<float> image{0, 1, 2, 3};
  const AirlightError error = airlight_error(image, image);
  for (double value : {error.bias, error.rmse, error.rrmse, error.mae, error.p99, error.max, error.relmse}) {
    EXPECT_EQ(value, 0.0);
  }
}

TEST(AirlightError, P99IsTheSmallestValueThat99PercentDoNotExceed) {
  // Differences 1, 2, … 200 against a reference of mean 1: 198 of them are at most 198.
  std::vector<float> r(200, 1.0f), x(200);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1.0f + static_cast<float>((i * 7) % 200 + 1);
  EXPECT_DOUBLE_EQ(airlight_error(x, r).p99, 198.0);
  EXPECT_DOUBLE_EQ(airlight_error(x, r).max, 200.0);
  // Of 101, 100 must not exceed it: the largest is left out.
  r.assign(101, 1.0f);
  x.assign(101, 2.0f);
  x[50] = 9.0f;
  EXPECT_DOUBLE_EQ(airlight_error(x, r).p99, 1.0);
}

TEST(AirlightError, IsNotRelativeToADarkReference) {
  const std::vector<float> black(4, 0.0f), dim(4, 1e-3f), x{0, 0, 0, 1};
  const auto expect_dark = [](const AirlightError& error, bool is_dark) {
    EXPECT_EQ(error.is_dark, is_dark);
    for (double value : {error.bias, error.rrmse, error.mae, error.p99, error.max, error.relmse, error.leaked,
                         error.spurious})
      EXPECT_EQ(std::isnan(value), is_dark);
    EXPECT_TRUE(std::isfinite(error.rmse));
  };
  expect_dark(airlight_error(black, black), true);
  expect_dark(airlight_error(x, black), true);
  EXPECT_DOUBLE_EQ(airlight_error(x, black).rmse, 0.5);
  expect_dark(airlight_error(x, dim), false);
  expect_dark(airlight_error(x, dim, 0.99e-3), false);
  expect_dark(airlight_error(x, dim, 1.01e-3), true);
}

TEST(AirlightError, AddsUpLargeImagesInDoublePrecision) {
  // In single precision the sum of 2²⁵ ones would stop at 2²⁴.
  const std::vector<float> r(std::size_t{1} << 25, 1.0f);
  std::vector<float> x(r);
  x[0] = 1.5f;
  EXPECT_NEAR(airlight_error(x, r).bias, 0.5 / static_cast<double>(r.size()), 1e-15);
}

TEST(AirlightError, RefusesNaNAndInfinity) {
  const std::vector<float> good{1, 2, 3};
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const std::vector<float> image{1, bad, 3};
    EXPECT_THROW(airlight_error(image, good), scene::Error);
    EXPECT_THROW(airlight_error(good, image), scene::Error);
  }
}

TEST(AirlightError, RefusesDifferentLengthsAndNoPixels) {
  const std::vector<float> three(3, 1.0f), four(4, 1.0f), none;
  EXPECT_THROW(airlight_error(three, four), scene::Error);
  EXPECT_THROW(airlight_error(none, none), scene::Error);
}

TEST(SameSurfaceError, LeavesOutPixelsThatSeeDifferentSurfaces) {
  // Four pixels of two channels; the second sees another surface, the third sees one where the reference sees
  // none.
  const std::vector<float> x{1, 3, 9, 9, 7, 7, 2, 2}, distance{1.0005f, 5, 4, 0};
  const std::vector<float> r{1, 1, 1, 1, 1, 1, 2, 4}, reference_distance{1, 4, 0, 0};
  const SameSurfaceError error = same_surface_error(x, distance, r, reference_distance);
  EXPECT_EQ(error.left_out_pixels, 2u);
  EXPECT_DOUBLE_EQ(error.bias, 0.0);                          // (1+3+2+2)/(1+1+2+4) − 1
  EXPECT_DOUBLE_EQ(error.rrmse, std::sqrt(8.0 / 4.0) / 2.0);  // sqrt((0+4+0+4)/4) / mean 2
  EXPECT_FALSE(error.is_dark);
  EXPECT_TRUE(same_surface_error(x, distance, r, reference_distance, 2.1).is_dark);
}

TEST(Flicker, IsWhatTheErrorChangesBy) {
  // Two by two pixels, one channel. The truth moves between frames; its means are 2 and 4.
  const std::vector<float> r0{1, 1, 2, 4}, r1{6, 2, 4, 4}, seen(4, 1.0f);
  const auto errors = [&](const std::vector<float>& r, const std::vector<float>& error) {
    std::vector<float> x(r);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += error[i];
    return error_image(x, seen, r, seen);
  };
  const auto flicker_of = [&](const std::vector<float>& before, const std::vector<float>& after) {
    return flicker(errors(r0, before), errors(r1, after));
  };
  EXPECT_EQ(flicker_of({0, 0, 0, 0}, {0, 0, 0, 0}), 0.0) << "the method moves as the truth does";
  EXPECT_EQ(flicker_of({0.5f, 0, -1, 0.25f}, {0.5f, 0, -1, 0.25f}), 0.0) << "what is wrong stays so";
  EXPECT_DOUBLE_EQ(flicker_of({0.5f, -0.5f, 0.5f, -0.5f}, {-0.5f, 0.5f, -0.5f, 0.5f}), 2.0 * 0.5 / 3.0);
  EXPECT_DOUBLE_EQ(flicker_of({0, 0, 0, 0}, {1, 0, 0, -2}), std::sqrt(5.0 / 4.0) / 3.0);
}

TEST(Flicker, IsOfThePixelsThatShowTheSameSurfaceInBothFrames) {
  // Three pixels of two channels. The second sees another surface than the truth in the first frame, the
  // third in the second.
  const std::vector<float> r(6, 2.0f), x0{2, 3, 9, 9, 2, 2}, x1{2, 2, 2, 2, 9, 9}, truth{1, 2, 0};
  const ErrorImage before = error_image(x0, std::vector<float>{1, 3, 0}, r, truth);
  const ErrorImage after = error_image(x1, std::vector<float>{1, 2, 5}, r, truth);
  EXPECT_DOUBLE_EQ(flicker(before, after), std::sqrt(1.0 / 2.0) / 2.0);
  // Where the truth moves to another surface, the pixel counts.
  const ErrorImage elsewhere = error_image(x1, std::vector<float>{7, 2, 5}, r, std::vector<float>{7, 2, 0});
  EXPECT_EQ(flicker(before, elsewhere), flicker(before, after));
  EXPECT_TRUE(std::isnan(flicker(before, error_image(x1, std::vector<float>{7, 2, 5}, r, truth))))
      << "no pixel is left";
}

TEST(Flicker, IsNotRelativeToADarkReference) {
  const std::vector<float> x{1, 2}, black(2, 0.0f), dim(2, 1e-3f), bright(2, 1.0f), seen(2, 1.0f);
  const ErrorImage lit = error_image(x, seen, bright, seen);
  EXPECT_TRUE(std::isnan(flicker(lit, error_image(x, seen, black, seen))));
  EXPECT_TRUE(std::isnan(flicker(error_image(x, seen, dim, seen, 1.01e-3), lit)));
  EXPECT_TRUE(std::isfinite(flicker(error_image(x, seen, dim, seen, 0.99e-3), lit)));
}

TEST(Flicker, RefusesNaNAndDifferentLengths) {
  const std::vector<float> two(2, 1.0f), three(3, 1.0f), bad{1, std::numeric_limits<float>::quiet_NaN()};
  EXPECT_THROW(error_image(bad, two, two, two), scene::Error);
  EXPECT_THROW(error_image(two, two, bad, two), scene::Error);
  EXPECT_THROW(error_image(two, two, three, two), scene::Error);
  EXPECT_THROW(flicker(error_image(two, two, two, two), error_image(three, three, three, three)),
               scene::Error);
}

TEST(SurfaceError, CountsWrongAndUndecidedPixelsOfThoseThatShowASurface) {
  using reference::Verdict;
  // Two by two pixels: right, wrong, undecided, and none that is seen.
  const SurfaceVerdicts verdicts{
      {{Verdict::lit, true}}, {{Verdict::dark, true}}, {{Verdict::lit, false}}, {}};
  const std::vector<float> visibility{0.5f, 0.5f, 0.0f, 1.0f};
  const SurfaceError error = surface_error(visibility, verdicts);
  EXPECT_EQ(error.pixels, 3u);
  EXPECT_EQ(error.wrong_pixels, 1u);
  EXPECT_EQ(error.undecided_pixels, 1u);
  EXPECT_DOUBLE_EQ(error.undecided(), 1.0 / 3.0);
  // Below a half is dark; an undecided pixel is wrong neither way.
  const std::vector<float> other{0.49f, 0.49f, 1.0f, 0.0f};
  EXPECT_EQ(surface_error(other, verdicts).wrong_pixels, 1u);
  EXPECT_EQ(surface_error(other, verdicts).undecided_pixels, 1u);
  EXPECT_EQ(surface_error(other, SurfaceVerdicts(4)).undecided(), 0.0) << "nothing is seen";
}

TEST(SurfaceError, RefusesNaNAndDifferentLengths) {
  const std::vector<float> good{1, 1}, bad{1, std::numeric_limits<float>::quiet_NaN()};
  EXPECT_THROW(surface_error(bad, SurfaceVerdicts(2)), scene::Error);
  EXPECT_THROW(surface_error(good, SurfaceVerdicts(3)), scene::Error);
}

}  // namespace
}  // namespace airlight::quality
