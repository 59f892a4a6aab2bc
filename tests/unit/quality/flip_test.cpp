// Numbers without a derivation are those of flip_values.py, which follows the papers' formulas without
// separating filters or leaving out taps, in double precision. Tolerances are those of single precision.

#include "quality/flip.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "scene/error.h"

namespace airlight::quality {
namespace {

constexpr glm::ivec2 k_size(21, 13);

void expect_near(const glm::vec3& value, const glm::dvec3& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 2e-6 * (1.0 + std::abs(expected[c]) * 20.0));
}

std::vector<glm::vec3> flat(const glm::vec3& colour, glm::ivec2 size = k_size) {
  return std::vector<glm::vec3>(static_cast<std::size_t>(size.x * size.y), colour);
}

std::vector<glm::vec3> pattern() {
  std::vector<glm::vec3> image;
  for (int y = 0; y < k_size.y; ++y)
    for (int x = 0; x < k_size.x; ++x)
      image.emplace_back(0.5 + 0.3 * ((x * 7 + y * 3) % 5) / 5.0, 0.2 + 0.03 * x, 0.1 + 0.05 * y);
  return image;
}

/// Red is off by −10 % on the left and +30 % on the right, and a pixel is white.
std::vector<glm::vec3> distorted() {
  std::vector<glm::vec3> image = pattern();
  for (std::size_t i = 0; i < image.size(); ++i) image[i].r *= i % 21 > 10 ? 1.3f : 0.9f;
  image[4 * 21 + 5] = glm::vec3(1.0f);
  for (glm::vec3& value : image) value = glm::min(value, 1.0f);
  return image;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(FlipColours, AreThoseOfTheFormulas) {
  const glm::vec3 opponents = flip::opponents({0.2f, 0.5f, 0.7f});
  // YCxCz is (116 y − 16, 500 (x − y), 200 (y − z)).
  expect_near(opponents,
              {(36.27344365265563 + 16) / 116, -21.425029597605587 / 500, -43.718996296370925 / 200});
  expect_near(flip::rgb_of_opponents(opponents), {0.2, 0.5, 0.7});
  expect_near(flip::hunt_lab({0.2f, 0.5f, 0.7f}), {72.9335639276042, -9.15832954697116, -15.757908628943296});
  expect_near(flip::hunt_lab({0.001f, 0.002f, 0.003f}),
              {1.679681372576308, -0.006776075288381901, -0.026042202865562948});
  expect_near(flip::hunt_lab(glm::vec3(1.0f)), {100.0, 0.0, 0.0});
  expect_near(flip::hunt_lab(glm::vec3(0.0f)), {0.0, 0.0, 0.0});
}

TEST(FlipColours, DifferByHyAB) {
  EXPECT_EQ(flip::hyab({50, 3, 4}, {45, 0, 0}), 10.0f);  // 5 + √(9 + 16)
  EXPECT_NEAR(flip::hyab(flip::hunt_lab({0, 1, 0}), flip::hunt_lab({0, 0, 1})), 203.29733420750716, 1e-3);
  EXPECT_EQ(flip::redistributed(0.0f), 0.0f);
  EXPECT_NEAR(flip::redistributed(1.0f), 0.05754020903080856, 1e-6);
  EXPECT_NEAR(flip::redistributed(10.0f), 0.28838418186485926, 1e-6);
  EXPECT_NEAR(flip::redistributed(100.0f), 0.9673805159055133, 1e-6);
  EXPECT_NEAR(flip::redistributed(203.29733420750716f), 1.0, 1e-6);
}

/// A tap of a filter of two dimensions.
double at(const flip::Taps& along, std::size_t x, const flip::Taps& across, std::size_t y) {
  return x < along.size() && y < across.size()
             ? static_cast<double>(along[x]) * static_cast<double>(across[y])
             : 0.0;
}

TEST(FlipFilters, OfContrastSensitivityAreThoseOfTheFormula) {
  const flip::SpatialFilters& filters = flip::spatial_filters();
  const auto expect_taps = [](std::span<const flip::Gaussian> parts, const std::vector<double>& expected) {
    const std::pair<std::size_t, std::size_t> places[] = {{0, 0}, {1, 0}, {3, 2}, {6, 0}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
      double tap = 0.0;
      for (const flip::Gaussian& part : parts)
        tap += static_cast<double>(part.weight) * at(part.taps, places[i].first, part.taps, places[i].second);
      EXPECT_NEAR(tap, expected[i], 1e-7);
    }
    double sum = 0.0;
    for (const flip::Gaussian& part : parts) {
      const double side = 2.0 * std::accumulate(part.taps.begin() + 1, part.taps.end(), 0.0) +
                          static_cast<double>(part.taps[0]);
      sum += static_cast<double>(part.weight) * side * side;
      EXPECT_LE(part.taps.size(), 11u);  // a radius of ⌈3 σ⌉ = 10
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
  };
  expect_taps({&filters.luminance, 1},
              {0.14890264357570773, 0.09327025447675659, 0.0003402766934047867, 7.230520053755228e-09});
  expect_taps({&filters.red_green, 1},
              {0.13204574086784618, 0.08720960332825795, 0.0006006801397347652, 4.3148060960596206e-08});
  expect_taps(filters.blue_yellow,
              {0.020012846957652288, 0.018737464826867136, 0.008655014605839772, 0.0021250599829508044});
}

TEST(FlipFilters, OfFeaturesAreThoseOfTheFormula) {
  const flip::FeatureFilters& filters = flip::feature_filters();
  EXPECT_EQ(filters.smooth.size(), 10u);  // a radius of ⌈3 σ⌉ = 9
  EXPECT_NEAR(at(filters.edge, 1, filters.smooth, 0), 0.018267513543710617, 1e-8);
  EXPECT_NEAR(at(filters.edge, 3, filters.smooth, 2), 0.024744772608968214, 1e-8);
  EXPECT_NEAR(at(filters.edge, 9, filters.smooth, 0), 0.0008199872712413867, 1e-8);
  EXPECT_NEAR(at(filters.point, 0, filters.smooth, 0), -0.043441848041649564, 1e-8);
  EXPECT_NEAR(at(filters.point, 3, filters.smooth, 2), 0.003586206490116921, 1e-8);
  EXPECT_NEAR(at(filters.point, 9, filters.smooth, 0), 0.002001203990333904, 1e-8);
}

TEST(Flip, OfAPatternIsThatOfTheFormulas) {
  const std::vector<float> map = flip::map(distorted(), pattern(), k_size);
  EXPECT_NEAR(mean(map), 0.24155484050620799, 2e-6);
  EXPECT_NEAR(map[0], 0.1662585771747137, 5e-6);
  EXPECT_NEAR(map[4 * 21 + 5], 0.3210453822880739, 5e-6);
  EXPECT_NEAR(map[6 * 21 + 11], 0.26896524510525244, 5e-6);
  EXPECT_NEAR(map.back(), 0.30105793135175, 5e-6);
}

TEST(Flip, OverExposuresIsThatOfTheFormulas) {
  std::vector<glm::vec3> x = distorted(), r = pattern();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float factor = std::pow(4.0f, static_cast<float>(i % 21) / 4.0f - 2.0f);
    x[i] *= factor;
    r[i] *= factor;
  }
  const std::vector<float> exposures = flip_exposures(r);
  ASSERT_EQ(exposures.size(), 6u);
  EXPECT_NEAR(exposures.front(), 0.025946656215910004, 1e-7);
  EXPECT_NEAR(exposures[2], 0.12181073499382164, 1e-6);
  EXPECT_NEAR(exposures.back(), 1.2390585042352298, 1e-5);
  EXPECT_NEAR(hdr_flip(x, r, k_size), 0.1550637636349113, 5e-6);
  // Nothing depends on the unit of radiance.
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] *= 1e-9f;
    r[i] *= 1e-9f;
  }
  EXPECT_NEAR(hdr_flip(x, r, k_size), 0.1550637636349113, 5e-6);
}

TEST(Flip, OfFlatImagesIsTheDistanceOfTheirColours) {
  // Filters keep what is flat, and it has no features but what rounding leaves: 1e-8, whose root is 1e-4.
  EXPECT_NEAR(ldr_flip(flat({0, 0, 0}), flat({1, 1, 1}), k_size, 1.0f), 0.9673805159055133, 1e-4);
  EXPECT_NEAR(ldr_flip(flat({0, 1, 0}), flat({0, 0, 1}), k_size, 1.0f), 1.0, 1e-4);
  const glm::vec3 a(0.2f, 0.5f, 0.7f), b(0.3f, 0.4f, 0.7f);
  EXPECT_NEAR(ldr_flip(flat(a), flat(b), k_size, 1.0f),
              static_cast<double>(flip::redistributed(flip::hyab(flip::hunt_lab(a), flip::hunt_lab(b)))),
              1e-4);
  // What the exposure makes white is all alike.
  EXPECT_EQ(ldr_flip(flat({3, 3, 3}), flat({2, 2, 2}), k_size, 1.0f), 0.0);
  EXPECT_GT(ldr_flip(flat({3, 3, 3}), flat({2, 2, 2}), k_size, 0.25f), 0.1);
}

TEST(Flip, OfEqualImagesIsZeroAndElseWithinOne) {
  EXPECT_EQ(ldr_flip(pattern(), pattern(), k_size, 1.0f), 0.0);
  EXPECT_EQ(hdr_flip(pattern(), pattern(), k_size), 0.0);
  for (const float value : flip::map(distorted(), pattern(), k_size)) {
    EXPECT_GT(value, 0.0f);
    EXPECT_LE(value, 1.0f);
  }
}

TEST(Flip, IsSymmetricOnADisplay) {
  EXPECT_NEAR(ldr_flip(distorted(), pattern(), k_size, 1.0f), ldr_flip(pattern(), distorted(), k_size, 1.0f),
              1e-7);
}

TEST(Flip, GrowsWithTheDifference) {
  double last = 0.0, last_hdr = 0.0;
  for (const float part : {0.01f, 0.03f, 0.1f, 0.3f, 1.0f}) {
    std::vector<glm::vec3> x = pattern();
    const std::vector<glm::vec3> far = distorted();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = glm::mix(x[i], far[i], part);
    const double now = ldr_flip(x, pattern(), k_size, 1.0f), now_hdr = hdr_flip(x, pattern(), k_size);
    EXPECT_GT(now, last);
    EXPECT_GT(now_hdr, last_hdr);
    last = now;
    last_hdr = now_hdr;
  }
}

TEST(Flip, OfAFineFlawIsLessThanOfABroadOne) {
  // A contrast that alternates from pixel to pixel is nearly invisible at 67 pixels per degree.
  constexpr glm::ivec2 size(64, 64);
  std::vector<glm::vec3> fine = flat(glm::vec3(0.5f), size), broad = fine;
  for (int i = 0; i < 64 * 64; ++i) {
    const int x = i % 64, y = i / 64;
    fine[static_cast<std::size_t>(i)] += 0.1f * ((x + y) % 2 == 0 ? 1.0f : -1.0f);
    broad[static_cast<std::size_t>(i)] += 0.1f * ((x / 32 + y / 32) % 2 == 0 ? 1.0f : -1.0f);
  }
  EXPECT_LT(ldr_flip(fine, flat(glm::vec3(0.5f), size), size, 1.0f),
            0.2 * ldr_flip(broad, flat(glm::vec3(0.5f), size), size, 1.0f));
}

TEST(Flip, DoesNotDependOnBandsOfRows) {
  // A flaw that moves down crosses the borders of what threads work on.
  constexpr glm::ivec2 size(32, 160);
  double first = 0.0;
  for (const int y : {20, 58, 63, 64, 70, 130}) {
    std::vector<glm::vec3> x = flat(glm::vec3(0.5f), size);
    x[static_cast<std::size_t>(y * size.x + 16)] = glm::vec3(1.0f, 0.2f, 0.2f);
    const double value = ldr_flip(x, flat(glm::vec3(0.5f), size), size, 1.0f);
    if (first == 0.0) first = value;
    EXPECT_NEAR(value, first, 1e-9);
  }
}

TEST(Flip, OfADarkReferenceIsNone) {
  EXPECT_TRUE(flip_exposures(flat(glm::vec3(0.0f))).empty());
  EXPECT_TRUE(std::isnan(hdr_flip(pattern(), flat(glm::vec3(0.0f)), k_size)));
  EXPECT_TRUE(std::isnan(hdr_flip(pattern(), flat(glm::vec3(1e-3f)), k_size, 1e-3 + 1e-9)));
  // The median is that of what is lit, however little that is.
  std::vector<glm::vec3> r = flat(glm::vec3(0.0f));
  r[3] = r[4] = glm::vec3(1.0f);
  EXPECT_EQ(flip_exposures(r).size(), 2u);
}

TEST(Flip, SurvivesAnyRange) {
  std::vector<glm::vec3> r = flat(glm::vec3(1e-30f)), x = r;
  r[3] = glm::vec3(1e30f);
  const double value = hdr_flip(x, r, k_size);
  EXPECT_TRUE(value > 0.0 && value <= 1.0);
}

TEST(Flip, RefusesNaNAndDifferentLengths) {
  std::vector<glm::vec3> bad = pattern();
  bad[7].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(hdr_flip(bad, pattern(), k_size), scene::Error);
  EXPECT_THROW(ldr_flip(pattern(), bad, k_size, 1.0f), scene::Error);
  bad.pop_back();
  EXPECT_THROW(hdr_flip(bad, pattern(), k_size), scene::Error);
  EXPECT_THROW(hdr_flip({}, {}, glm::ivec2(0)), scene::Error);
}

}  // namespace
}  // namespace airlight::quality
