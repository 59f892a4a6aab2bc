#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "epipolar/space_math.h"
#include "support/random.h"

/// shaders/epipolar/space.glsl against the same formulas in double precision, at the same single-precision
/// inputs.
namespace airlight::shaders {
namespace {

using tests::Random;

constexpr double k_pi_exactly = std::numbers::pi;

/// What a few roundings to single precision leave of a result.
constexpr double k_single = 1e-6;

EpipolarBlock make_space(glm::dvec3 axis, double distance) {
  const epipolar::Axes axes = epipolar::make_axes(axis);
  EpipolarBlock space{};
  space.axis = glm::vec3(axes.axis);
  space.u = glm::vec3(axes.u);
  space.f = glm::vec3(axes.f);
  space.distance = static_cast<float>(distance);
  space.inverse_distance = static_cast<float>(1.0 / distance);
  return space;
}

template <class Number>
double exact(Number value) {
  return static_cast<double>(value);
}

float number(Angle angle) {
  return static_cast<float>(angle);
}

Angle single(double angle) {
  return Angle(static_cast<float>(angle));
}

EyeAngle make_angle(double alpha) {
  return {.sine = static_cast<float>(std::sin(alpha)), .cosine = static_cast<float>(std::cos(alpha))};
}

/// Angles over (0, π), as near to both ends as 1e-6.
std::vector<double> hard_angles() {
  std::vector<double> angles;
  for (double distance = 1e-6; distance < 1.5; distance *= 1.7) {
    angles.push_back(distance);
    angles.push_back(k_pi_exactly - distance);
  }
  angles.push_back(0.5 * k_pi_exactly);
  return angles;
}

TEST(EyeAngle, IsZeroRightAndStraight) {
  const EpipolarBlock space = make_space({0, 0, 1}, 1.0);
  const EyeAngle ahead = eye_angle(space, {0, 0, 1}, 0.0f);
  EXPECT_EQ(ahead.sine, 0.0f);
  EXPECT_EQ(alpha_of(ahead), Angle(0.0f));
  EXPECT_FLOAT_EQ(number(alpha_complement(ahead)), k_pi);
  const EyeAngle across = eye_angle(space, {0, 1, 0}, 0.0f);
  EXPECT_FLOAT_EQ(number(alpha_of(across)), 0.5f * k_pi);
  EXPECT_FLOAT_EQ(number(alpha_complement(across)), 0.5f * k_pi);
  const EyeAngle back = eye_angle(space, {0, 0, -1}, 0.0f);
  EXPECT_FLOAT_EQ(number(alpha_of(back)), k_pi);
  EXPECT_EQ(alpha_complement(back), Angle(0.0f));
}

TEST(EyeAngle, KeepsAllDigitsNearTheAxis) {
  const EpipolarBlock space = make_space({0, 1, 0}, 1.0);
  for (double alpha : hard_angles()) {
    const glm::vec3 ray(std::sin(alpha), std::cos(alpha), 0.0);
    const EyeAngle angle = eye_angle(space, ray, 0.0f);
    EXPECT_NEAR(exact(angle.sine) / std::sin(alpha), 1.0, k_single) << alpha;
    EXPECT_NEAR(exact(alpha_of(angle)) / alpha, 1.0, k_single);
    EXPECT_NEAR(exact(alpha_complement(angle)) / (k_pi_exactly - alpha), 1.0, k_single) << alpha;
  }
}

TEST(EyeAngle, ASlantedAxisCostsTheRoundingOfItsComponents) {
  // Axis and ray are themselves rounded by 6e-8 in each component, and so is each product: an absolute error
  // of sin α.
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 axis = random.direction();
    const EpipolarBlock space = make_space(axis, 1.0);
    const double alpha = random.uniform() < 0.5 ? random.logarithmic(1e-6, k_pi_exactly / 2)
                                                : k_pi_exactly - random.logarithmic(1e-6, k_pi_exactly / 2);
    const double theta = random.uniform(-k_pi_exactly, k_pi_exactly);
    const epipolar::Axes axes = epipolar::make_axes(axis);
    const glm::dvec3 ray =
        std::sin(alpha) * (std::cos(theta) * axes.u + std::sin(theta) * axes.f) + std::cos(alpha) * axes.axis;
    const EyeAngle angle = eye_angle(space, glm::vec3(ray), 0.0f);
    EXPECT_NEAR(exact(angle.sine), std::sin(alpha), 2.5e-7) << alpha;
    EXPECT_NEAR(exact(alpha_of(angle)), alpha, 5e-7);
    EXPECT_NEAR(exact(alpha_complement(angle)), k_pi_exactly - alpha, 5e-7);
  }
}

TEST(EyeAngle, StaysAQuarterPixelOffTheAxis) {
  const EpipolarBlock space = make_space({0, 0, 1}, 1.0);
  const float quarter = 1e-3f;
  for (float offset : {0.0f, 1e-6f, 9e-4f}) {
    EXPECT_EQ(eye_angle(space, glm::normalize(glm::vec3(offset, 0, 1)), quarter).sine, quarter);
    EXPECT_LE(eye_angle(space, glm::normalize(glm::vec3(offset, 0, -1)), quarter).sine,
              std::max(offset, 1e-5f));
  }
  EXPECT_FLOAT_EQ(number(alpha_of(eye_angle(space, {0, 0, 1}, quarter))), quarter);
  EXPECT_NEAR(eye_angle(space, glm::normalize(glm::vec3(2e-3f, 0, 1)), quarter).sine, 2e-3f, 1e-8f);
}

TEST(Theta, GrowsFromUTowardsF) {
  const EpipolarBlock space = make_space(glm::normalize(glm::dvec3(1, 2, 3)), 1.0);
  EXPECT_NEAR(exact(theta_of(space, space.u)), 0.0, k_single);
  EXPECT_NEAR(exact(theta_of(space, space.f)), 0.5 * k_pi_exactly, k_single);
  EXPECT_NEAR(std::abs(exact(theta_of(space, -space.u))), k_pi_exactly, k_single);
  EXPECT_NEAR(exact(theta_of(space, -space.f)), -0.5 * k_pi_exactly, k_single);
}

/// Unit vector at an angle from the axis, in the half-plane at θ.
glm::vec3 direction_at(const EpipolarBlock& space, double angle, double theta) {
  const glm::dvec3 outward = std::cos(theta) * glm::dvec3(space.u) + std::sin(theta) * glm::dvec3(space.f);
  return glm::vec3(std::cos(angle) * glm::dvec3(space.axis) + std::sin(angle) * outward);
}

TEST(Theta, IsZeroOnTheAxis) {
  const EpipolarBlock space = make_space({0, 0, 1}, 1.0);
  EXPECT_EQ(theta_of(space, {0, 0, 0}), Angle(0.0f));
  EXPECT_EQ(theta_of(space, {0, 0, 5}), Angle(0.0f));
  EXPECT_EQ(theta_of(space, {0, 0, -5}), Angle(0.0f));
}

TEST(Theta, DoesNotDependOnWhereInTheHalfPlaneAVectorPoints) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const EpipolarBlock space = make_space(random.direction(), 1.0);
    const Angle theta = single(random.uniform(-3.14, 3.14));
    const double angle = random.uniform(0.01, 3.13);
    // 1/sin α magnifies the rounding of the vector's components.
    const double tolerance = 4e-7 / std::sin(angle);
    EXPECT_NEAR(exact(theta_of(space, direction_at(space, angle, exact(theta)))), exact(theta), tolerance)
        << angle;
  }
}

TEST(Theta, KeepsItsDigitsOnBothSidesOfTheSeam) {
  const EpipolarBlock space = make_space(glm::normalize(glm::dvec3(3, -1, 2)), 1.0);
  for (double offset : {1e-3, 1e-5}) {
    for (double theta : {k_pi_exactly - offset, offset - k_pi_exactly})
      EXPECT_NEAR(exact(theta_of(space, direction_at(space, 1.0, theta))), theta, k_single);
  }
}

TEST(Phi, IsZeroAtTheEyeAndGrowsToPiMinusAlpha) {
  const EpipolarBlock space = make_space({0, 0, 1}, 2.0);
  for (double alpha : {0.01, 0.5, 1.5707963, 2.5, 3.13}) {
    const EyeAngle angle = make_angle(alpha);
    EXPECT_EQ(phi_at(space, angle, 0.0f), Angle(0.0f));
    Angle last(0.0f);
    for (double t = 1e-6; t < 1e7; t *= 1.5) {
      const Angle phi = phi_at(space, angle, static_cast<float>(t));
      EXPECT_GE(phi, last);
      last = phi;
    }
    EXPECT_NEAR(exact(last), k_pi_exactly - alpha, 1e-5);
  }
}

TEST(Phi, EqualsTheDoublePrecisionAngle) {
  Random random(3);
  for (int i = 0; i < 50000; ++i) {
    const EpipolarBlock space = make_space({0, 0, 1}, random.logarithmic(1e-3, 1e3));
    const EyeAngle angle = make_angle(random.uniform(1e-3, k_pi_exactly - 1e-3));
    const auto t = static_cast<float>(exact(space.distance) * random.logarithmic(1e-4, 1e4));
    const double across = exact(t) * exact(angle.sine);
    const double along = exact(space.distance) - exact(t) * exact(angle.cosine);
    const double phi = std::atan2(across, along);
    // t cos α and D each carry a rounding; seen from the light at distance r it is an angle.
    const double rounding = 1.2e-7 * (exact(t) + exact(space.distance)) / std::hypot(across, along);
    EXPECT_NEAR(exact(phi_at(space, angle, t)), phi, k_single * phi + rounding * std::abs(std::sin(phi)));
  }
}

TEST(Phi, KeepsAllDigitsCloseToTheEye) {
  const EpipolarBlock space = make_space({0, 0, 1}, 1.0);
  for (double alpha : hard_angles()) {
    const EyeAngle angle = make_angle(alpha);
    for (double t : {1e-6, 1e-4, 1e-2}) {
      const double expected = std::atan2(t * std::sin(alpha), 1.0 - t * std::cos(alpha));
      EXPECT_NEAR(exact(phi_at(space, angle, static_cast<float>(t))) / expected, 1.0, k_single)
          << alpha << " " << t;
    }
  }
}

TEST(Phi, IsTheInverseOfTheDistanceByTheLawOfSines) {
  Random random(4);
  for (int i = 0; i < 50000; ++i) {
    const EpipolarBlock space = make_space({0, 0, 1}, random.logarithmic(0.1, 100.0));
    const double alpha = random.uniform(1e-3, k_pi_exactly - 1e-3);
    const EyeAngle angle = make_angle(alpha);
    const double phi = (k_pi_exactly - alpha) * random.uniform(1e-4, 0.99);
    const auto t = static_cast<float>(exact(space.distance) * std::sin(phi) / std::sin(alpha + phi));
    // Where the rays are nearly parallel, or the point is near the light, t magnifies the rounding of φ:
    // dt/dφ = r²/(D sin α), dφ/dt = D sin α / r².
    const double r = exact(space.distance) * std::sin(alpha) / std::sin(alpha + phi);
    const double slope = r * r / (exact(space.distance) * std::sin(alpha));
    EXPECT_NEAR(exact(phi_at(space, angle, t)), phi,
                k_single * phi + 2e-7 * (exact(t) + exact(space.distance) + slope) / slope)
        << alpha;
  }
}

TEST(AlphaAt, IsTheAngleOfAPointOnALightRay) {
  Random random(5);
  for (int i = 0; i < 50000; ++i) {
    const EpipolarBlock space = make_space({0, 0, 1}, random.logarithmic(1e-3, 1e3));
    const auto phi = static_cast<float>(random.uniform(1e-3, k_pi_exactly - 1e-3));
    const auto r = static_cast<float>(exact(space.distance) * random.logarithmic(1e-4, 1e4));
    const float sine = std::sin(phi), cosine = std::cos(phi);
    const double across = exact(r) * exact(sine), along = exact(space.distance) - exact(r) * exact(cosine);
    const double alpha = std::atan2(across, along);
    const double rounding = 1.2e-7 * (exact(r) + exact(space.distance)) / std::hypot(across, along);
    EXPECT_NEAR(exact(alpha_at(space, sine, cosine, r)), alpha,
                k_single * alpha + rounding * std::abs(std::sin(alpha)));
  }
}

TEST(AlphaAt, FallsFromPiMinusPhiAtInfinityToZeroAtTheLight) {
  const EpipolarBlock space = make_space({0, 0, 1}, 1.0);
  for (float phi : {0.3f, 1.5f, 3.0f}) {
    EXPECT_EQ(alpha_at(space, std::sin(phi), std::cos(phi), 0.0f), Angle(0.0f));
    EXPECT_NEAR(exact(alpha_at(space, std::sin(phi), std::cos(phi), 1e8f)), k_pi_exactly - exact(phi),
                k_single);
  }
}

TEST(PathLength, IsTheDistanceFromLightToEyeWhereThePointIsOnTheSegment) {
  const EpipolarBlock space = make_space({0, 0, 1}, 7.0);
  EXPECT_FLOAT_EQ(path_length(space, k_half_turn, Angle(0.0f)), 7.0f);   // α = φ = 0: between the two
  EXPECT_FLOAT_EQ(path_length(space, Angle(2.0f), Angle(0.0f)), 7.0f);   // φ = 0: at the eye
  EXPECT_FLOAT_EQ(path_length(space, Angle(1e-4f), Angle(0.0f)), 7.0f);  // at the eye, light behind
}

TEST(PathLength, EqualsTheSumOfBothDistances) {
  Random random(8);
  for (int i = 0; i < 100000; ++i) {
    const EpipolarBlock space = make_space({0, 0, 1}, random.logarithmic(1e-3, 1e3));
    const Angle complement = single(random.uniform() < 0.5 ? random.logarithmic(1e-6, 3.1)
                                                           : k_pi_exactly - random.logarithmic(1e-6, 1.0));
    const Angle phi = single(exact(complement) * (random.uniform() < 0.5 ? random.uniform(0.0, 0.999)
                                                                         : random.logarithmic(1e-6, 0.999)));
    const double D = exact(space.distance), alpha = k_pi_exactly - exact(complement);
    // The point, from the law of sines, in double.
    const double sine = std::sin(exact(complement) - exact(phi));  // sin(α + φ)
    if (std::abs(sine) < 1e-9) continue;                           // the law of sines is 0/0 there
    const double t = D * std::sin(exact(phi)) / sine;
    const glm::dvec2 point(t * std::sin(alpha), t * std::cos(alpha));
    const double path = t + glm::length(point - glm::dvec2(0.0, D));
    // Behind the light, where α → 0 and φ → π, the rounding of φ itself is seen against sin((π − α + φ)/2) →
    // 0.
    const double rounding = 3e-7 / std::sin(0.5 * (exact(complement) + exact(phi)));
    EXPECT_NEAR(exact(path_length(space, complement, phi)) / path, 1.0, k_single + rounding)
        << "complement " << complement << " phi " << phi;
  }
}

TEST(PathLength, IsHugeAndNeverNaNAtInfinity) {
  const EpipolarBlock space = make_space({0, 0, 1}, 3.0);
  for (float complement : {1e-6f, 0.1f, 1.0f, 3.0f, k_pi}) {
    const auto path = [&](float phi) { return path_length(space, Angle(complement), Angle(phi)); };
    EXPECT_GE(path(complement), 1e30f) << complement;
    EXPECT_GE(path(std::nextafter(complement, 4.0f)), 1e30f);
    EXPECT_GE(path(std::nextafter(complement, 0.0f)), 3.0f) << "no NaN";
  }
  EXPECT_GE(path_length(space, Angle(0.0f), Angle(0.0f)), 1e30f);
}

TEST(PathLength, GrowsAlongTheViewRay) {
  const EpipolarBlock space = make_space({0, 0, 1}, 1.0);
  for (const Angle complement : {Angle(0.01f), Angle(1.0f), Angle(2.0f), Angle(3.1f)}) {
    float last = 0.0f;
    for (int i = 0; i < 1000; ++i) {
      const float path = path_length(space, complement, complement * static_cast<float>(i) / 1000.0f);
      EXPECT_GE(path, last * 0.9999995f);
      last = path;
    }
  }
}

TEST(AngleOrder, RunsFromZeroToTwo) {
  EXPECT_EQ(angle_order(0.0f, 1.0f), Order(0.0f));
  EXPECT_EQ(angle_order(1.0f, 0.0f), Order(1.0f));
  EXPECT_EQ(angle_order(0.0f, -1.0f), Order(2.0f));
  EXPECT_EQ(angle_order(0.0f, 0.0f), Order(0.0f));
  EXPECT_EQ(angle_from_order(Order(0.0f)), Angle(0.0f));
  EXPECT_FLOAT_EQ(number(angle_from_order(Order(1.0f))), 0.5f * k_pi);
  EXPECT_FLOAT_EQ(number(angle_from_order(Order(2.0f))), k_pi);
}

TEST(AngleOrder, GrowsWithTheAngleWhateverTheLength) {
  Random random(9);
  Order last(0.0f);
  for (int i = 1; i <= 20000; ++i) {
    const double angle = k_pi_exactly * i / 20000.0;
    const double length = random.logarithmic(1e-6, 1e6);
    const Order order = angle_order(static_cast<float>(std::abs(length * std::sin(angle))),
                                    static_cast<float>(length * std::cos(angle)));
    EXPECT_GT(order, last) << angle;
    last = order;
    EXPECT_NEAR(exact(angle_from_order(order)), angle, 5e-7) << "two roundings of a number up to 2";
  }
}

}  // namespace
}  // namespace airlight::shaders
