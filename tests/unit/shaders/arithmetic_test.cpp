#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "epipolar/space_math.h"
#include "support/random.h"
#include "support/rough_shaders.h"

/// shaders/arithmetic.glsl against the same functions in double precision, at the same single-precision
/// inputs.
namespace airlight::shaders {
namespace {

using std::numbers::pi;

template <class Number>
double exact(Number value) {
  return static_cast<double>(value);
}

double exact(rough::Rough value) {
  return exact(static_cast<float>(value));
}

double exact(rough::Angle value) {
  return exact(rough::Rough(value));
}

/// What roundings to nearest leave of what the shaders claim for any rounding.
constexpr double k_claimed = 3e-7, k_to_nearest = 1.3e-7;

TEST(SineAndCosine, AreRightOverTheirRange) {
  double sine_error = 0.0, cosine_error = 0.0;
  for (double x = -4.0 * pi; x <= 4.0 * pi; x += 1e-5) {
    const Angle angle(static_cast<float>(x));
    sine_error = std::max(sine_error, std::abs(exact(sine(angle)) - std::sin(exact(angle))));
    cosine_error = std::max(cosine_error, std::abs(exact(cosine(angle)) - std::cos(exact(angle))));
  }
  EXPECT_LT(sine_error, k_to_nearest);
  EXPECT_LT(cosine_error, k_to_nearest);
}

TEST(SineAndCosine, KeepAllDigitsNearZeroAndARightAngle) {
  for (double x = 1e-37; x < 0.5 * pi; x *= 1.0003) {
    for (const Angle angle : {Angle(static_cast<float>(x)), Angle(static_cast<float>(-x))}) {
      EXPECT_NEAR(exact(sine(angle)) / std::sin(exact(angle)), 1.0, k_claimed) << angle;
      EXPECT_NEAR(exact(sine_of_quarter(angle)) / std::sin(exact(angle)), 1.0, k_claimed) << angle;
    }
    // Near ±π/2 the cosine is as small as the angle is near; π/2 itself is reduced to 5e-12.
    const Angle beside(static_cast<float>(0.5 * pi - x));
    if (x > 1e-7) {
      EXPECT_NEAR(exact(cosine(beside)) / std::cos(exact(beside)), 1.0, k_claimed + 6e-12 / x) << beside;
    }
  }
  EXPECT_EQ(sine(Angle(0.0f)), 0.0f);
  EXPECT_FLOAT_EQ(cosine(Angle(0.0f)), 1.0f);
  EXPECT_FLOAT_EQ(sine(0.5f * k_half_turn), 1.0f);
  EXPECT_FLOAT_EQ(cosine(k_half_turn), -1.0f);
  EXPECT_NEAR(sine(k_half_turn), 0.0f, 1e-7f);
  EXPECT_NEAR(cosine(0.5f * k_half_turn), 0.0f, 1e-7f);
}

TEST(SineAndCosine, OfABorderBetweenHalfTurnsAreContinuous) {
  for (int half_turn = -8; half_turn < 8; ++half_turn) {
    for (const double offset : {0.0, 0.5}) {
      auto below = static_cast<float>((half_turn + offset) * pi);
      for (int i = 0; i < 8; ++i) below = std::nextafter(below, -20.0f);
      for (int i = 0; i < 16; ++i, below = std::nextafter(below, 20.0f)) {
        EXPECT_NEAR(exact(sine(Angle(below))), std::sin(exact(below)), k_to_nearest);
        EXPECT_NEAR(exact(cosine(Angle(below))), std::cos(exact(below)), k_to_nearest);
      }
    }
  }
}

TEST(AngleOf, IsRightInAllFourQuadrants) {
  tests::Random random(1);
  for (int i = 0; i < 500000; ++i) {
    const double size = random.logarithmic(1e-30, 1e30);
    const auto x = static_cast<float>(size * random.uniform(-1, 1) * random.logarithmic(1e-6, 1));
    const auto y = static_cast<float>(size * random.uniform(-1, 1) * random.logarithmic(1e-6, 1));
    const double angle = std::atan2(exact(y), exact(x));
    EXPECT_NEAR(exact(angle_of(y, x)), angle, 2e-7 * std::abs(angle)) << y << " " << x;
  }
  EXPECT_EQ(angle_of(0.0f, 0.0f), Angle(0.0f));
  EXPECT_EQ(angle_of(0.0f, 1.0f), Angle(0.0f));
  EXPECT_EQ(angle_of(0.0f, -1.0f), k_half_turn);
}

/// What shaders/arithmetic.glsl claims, in the worst arithmetic that GLSL allows.
class InRoughArithmetic : public testing::TestWithParam<int> {
 public:
  InRoughArithmetic() { rough::Rough::lean = GetParam(); }
};

TEST_P(InRoughArithmetic, SinesAreRightToThreeTenMillionths) {
  tests::Random random(4);
  for (int i = 0; i < 300000; ++i) {
    const auto x = static_cast<float>(random.uniform(-4.0 * pi, 4.0 * pi));
    EXPECT_NEAR(exact(rough::sine(rough::Angle(x))), std::sin(exact(x)), k_claimed) << x;
    EXPECT_NEAR(exact(rough::cosine(rough::Angle(x))), std::cos(exact(x)), k_claimed) << x;
    const auto small = static_cast<float>(random.logarithmic(1e-30, 0.5 * pi));
    EXPECT_NEAR(exact(rough::sine(rough::Angle(small))) / std::sin(exact(small)), 1.0, 4e-7) << small;
    EXPECT_NEAR(exact(rough::sine_of_quarter(rough::Angle(small))) / std::sin(exact(small)), 1.0, 4e-7)
        << small;
  }
}

TEST_P(InRoughArithmetic, AnglesAreRightToTwelveTenMillionths) {
  tests::Random random(5);
  for (int i = 0; i < 300000; ++i) {
    const auto x = static_cast<float>(random.uniform(-1, 1) * random.logarithmic(1e-6, 1));
    const auto y = static_cast<float>(random.uniform(-1, 1) * random.logarithmic(1e-6, 1));
    EXPECT_NEAR(exact(rough::angle_of(y, x)), std::atan2(exact(y), exact(x)), 1.2e-6) << y << " " << x;
  }
}

TEST_P(InRoughArithmetic, AnOrderRoundedBeyondItsRangeIsStillAnAngle) {
  for (int i = 0; i < 1000; ++i) {
    const rough::Angle back = rough::angle_from_order(rough::angle_order(0.0f, -1.3f));
    EXPECT_NEAR(exact(back), pi, 2e-6);
    const rough::Angle ahead = rough::angle_from_order(rough::angle_order(0.0f, 1.3f));
    EXPECT_NEAR(exact(ahead), 0.0, 2e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Lean, InRoughArithmetic, testing::Values(-1, 0, 1));

TEST(OrderedDot, IsTheDotProduct) {
  tests::Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 a(random.in_box(3)), b(random.in_box(3));
    EXPECT_NEAR(exact(ordered_dot(a, b)), glm::dot(glm::dvec3(a), glm::dvec3(b)), 27 * 1.2e-7);
  }
}

TEST(UnitOr, IsAUnitVectorOrTheOther) {
  tests::Random random(3);
  const glm::vec3 other(0.0f, 1.0f, 0.0f);
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 direction = random.direction();
    // As small as squares that are 0 in single precision.
    const glm::vec3 unit = unit_or(glm::vec3(random.logarithmic(1e-29, 1e29) * direction), other);
    EXPECT_LT(glm::length(glm::dvec3(unit) - direction), 4e-7);
  }
  EXPECT_EQ(unit_or(glm::vec3(0.0f), other), other);
  EXPECT_EQ(unit_or(glm::vec3(1e-40f, 0.0f, 0.0f), other), other);
}

}  // namespace
}  // namespace airlight::shaders
