#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "media/medium.h"
#include "support/random.h"

/// shaders/media/row_end.glsl: where a neighbouring ray meets the plane that a ray ends on.
namespace airlight::shaders {
namespace {

using std::numbers::pi;

/// Two neighbouring view rays and a plane, in double precision, with the eye at the origin.
struct Scene {
  double distance = 2.0;  ///< D, the light being on the z axis
  double alpha = 0.5, theta = 0.3, d_alpha = 0.0, d_theta = 0.0;
  double w = 3.0;  ///< where the first ray ends
  glm::dvec3 normal{0.0, 0.0, -1.0};
};

glm::dvec3 direction(double alpha, double theta) {
  return {std::sin(alpha) * std::cos(theta), std::sin(alpha) * std::sin(theta), std::cos(alpha)};
}

double phi_of(const Scene& scene, double alpha, double t) {
  return std::atan2(t * std::sin(alpha), scene.distance - t * std::cos(alpha));
}

/// How far along the row's ray the plane is; infinite where it never meets it.
double row_distance(const Scene& scene) {
  const double plane = scene.w * glm::dot(scene.normal, direction(scene.alpha, scene.theta));
  const double facing =
      glm::dot(scene.normal, direction(scene.alpha + scene.d_alpha, scene.theta + scene.d_theta));
  return facing < 0.0 ? plane / facing : std::numeric_limits<double>::infinity();
}

double exactly(const Scene& scene) {
  const double row_alpha = scene.alpha + scene.d_alpha, t = row_distance(scene);
  const double end = std::isinf(t) ? pi - row_alpha : phi_of(scene, row_alpha, t);
  return end - phi_of(scene, scene.alpha, scene.w);
}

float by_shader(const Scene& scene) {
  EpipolarBlock space{};
  space.axis = {0.0f, 0.0f, 1.0f};
  space.u = {1.0f, 0.0f, 0.0f};
  space.f = {0.0f, 1.0f, 0.0f};
  space.distance = static_cast<float>(scene.distance);
  space.inverse_distance = static_cast<float>(1.0 / scene.distance);
  const EyeAngle angle{.sine = static_cast<float>(std::sin(scene.alpha)),
                       .cosine = static_cast<float>(std::cos(scene.alpha))};
  return static_cast<float>(phi_to_row_end(
      space, angle, glm::vec3(direction(scene.alpha, scene.theta)), glm::vec4(scene.normal, scene.w),
      Angle(static_cast<float>(scene.d_alpha)), Angle(static_cast<float>(scene.d_theta)), 0.0f));
}

TEST(PhiToRowEnd, IsTheChangeOfPhiOnThePlane) {
  tests::Random random(1);
  int samples = 0;
  while (samples < 20000) {
    Scene scene{.distance = random.logarithmic(0.1, 100.0),
                .alpha = random.uniform(0.05, 3.0),
                .theta = random.uniform(-3.0, 3.0),
                .d_alpha = random.uniform(-3e-3, 3e-3),
                .normal = random.direction()};
    scene.d_theta = random.uniform(-3e-3, 3e-3);
    scene.w = scene.distance * random.logarithmic(0.01, 100.0);
    const double facing = -glm::dot(scene.normal, direction(scene.alpha, scene.theta));
    if (facing < 0.2) continue;
    ++samples;
    // To first order: what is left is of second order in the angle between the rays, over how the plane faces
    // them, and seen from the light as much larger as the point is nearer to it than to the eye. Roundings
    // are magnified likewise.
    const double t = scene.w, D = scene.distance;
    const double r = std::hypot(t * std::sin(scene.alpha), D - t * std::cos(scene.alpha));
    const double steps = std::hypot(scene.d_alpha, scene.d_theta) / facing * (1.0 + t / r);
    EXPECT_NEAR(static_cast<double>(by_shader(scene)), exactly(scene),
                4.0 * steps * steps + 2e-6 * (1.0 + t / r) / facing);
  }
}

/// A plane at right angles to the half-plane of θ = 0, which rays of θ = 0 meet at α < `slope`.
Scene grazed(double slope, double alpha) {
  Scene scene;
  scene.alpha = alpha;
  scene.theta = 0.0;
  scene.normal = {std::cos(slope), 0.0, -std::sin(slope)};
  return scene;
}

TEST(PhiToRowEnd, OfARowThatMissesThePlaneIsTheEndOfItsRay) {
  Scene scene = grazed(0.7, 0.699);
  for (const double d_alpha : {0.0012, 0.002, 0.01}) {
    scene.d_alpha = d_alpha;
    ASSERT_TRUE(std::isinf(row_distance(scene)));
    EXPECT_NEAR(static_cast<double>(by_shader(scene)), exactly(scene), 2.0 * d_alpha * d_alpha + 1e-5);
  }
}

TEST(PhiToRowEnd, OfARowParallelToThePlaneIsTheEndOfItsRay) {
  // Exactly so in single precision: a floor under the eye, and the row's ray at right angles to its normal.
  EpipolarBlock space{};
  space.axis = {0.0f, 0.0f, 1.0f};
  space.distance = 2.0f;
  space.inverse_distance = 0.5f;
  const EyeAngle angle{.sine = 0.6f, .cosine = 0.8f};
  // u is downwards: the pixel's ray meets the floor, and the row's is the axis itself.
  const Angle d_alpha(-0.75f);  // α' = 0 to first order: 0.6 − 0.75 · 0.8
  const auto end = static_cast<float>(phi_to_row_end(space, angle, {0.6f, 0.0f, 0.8f},
                                                     {-1.0f, 0.0f, 0.0f, 1.0f}, d_alpha, Angle(0.0f), 0.0f));
  EXPECT_TRUE(std::isfinite(end));
  EXPECT_GT(end, 1.0f) << "beyond any cell in question";
}

TEST(PhiToRowEnd, IsFiniteAndOnTheRightSideHoweverThePlaneIsGrazed) {
  for (const double graze : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    for (const double w : {1e-30, 1e-3, 1.0, 1e3, 1e6}) {
      for (const double step : {-3e-3, -1e-5, 0.0, 1e-5, 3e-3}) {
        Scene scene = grazed(0.7, 0.7 - graze);
        scene.w = w;
        scene.d_alpha = step;
        const float end = by_shader(scene);
        ASSERT_TRUE(std::isfinite(end)) << graze << " " << w << " " << step;
        ASSERT_LE(std::abs(end), k_pi + 1e-6f);
        // Towards the plane the row's ray ends earlier, away from it later; far away, both end where rays go
        // on for ever.
        if (std::abs(step) > 10.0 * graze + 1e-6 && w >= 1e-3 && w <= 1.0) {
          EXPECT_EQ(end > 0.0f, step > 0.0) << graze << " " << w << " " << step;
        }
      }
    }
  }
}

TEST(PhiToRowEnd, OfANearerPlaneIsThatOfThePlaneThere) {
  // A wall across the axis, one metre away and half a metre: the ray of 45° ends at φ = 45° and at
  // atan(0.5/1.5).
  EpipolarBlock space{};
  space.axis = {0.0f, 0.0f, 1.0f};
  space.distance = 2.0f;
  space.inverse_distance = 0.5f;
  const float half = std::sqrt(0.5f);
  const auto nearer =
      static_cast<float>(phi_to_row_end(space, {.sine = half, .cosine = half}, {half, 0.0f, half},
                                        {0.0f, 0.0f, -1.0f, 1.0f / half}, Angle(0.0f), Angle(0.0f), 0.5f));
  EXPECT_NEAR(nearer, std::atan(0.5 / 1.5) - 0.25 * std::numbers::pi, 1e-6);
}

TEST(PhiToRowEnd, IsZeroWithoutAnythingToGoBy) {
  // The eye in the plane, and both rays too.
  EpipolarBlock space{};
  space.axis = {0.0f, 0.0f, 1.0f};
  space.distance = 2.0f;
  space.inverse_distance = 0.5f;
  EXPECT_EQ(phi_to_row_end(space, {.sine = 0.6f, .cosine = 0.8f}, {0.6f, 0.0f, 0.8f},
                           {0.0f, 1.0f, 0.0f, 1.0f}, Angle(0.001f), Angle(0.0f), 0.0f),
            Angle(0.0f));
}

}  // namespace
}  // namespace airlight::shaders
