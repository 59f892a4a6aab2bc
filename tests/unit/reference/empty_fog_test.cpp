#include <gtest/gtest.h>

#include "unit/reference/fixtures.h"

/// Fog without shadows, against an integral over t by another quadrature.
namespace airlight::reference {
namespace {

using scene::PhaseFunction;
using tests::airlight_over_distance;
using tests::one_pixel_view;

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// Images are single precision; the quadrature promises 1e-6.
constexpr double k_tolerance = 1e-6;
/// Below this, single precision loses digits.
constexpr double k_smallest = 1e-37;

void expect_near(glm::vec3 radiance, glm::dvec3 expected, const std::string& what,
                 double tolerance = k_tolerance) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(static_cast<double>(radiance[channel]), expected[channel],
                std::max(tolerance * expected[channel], k_smallest))
        << what << ", channel " << channel;
  }
}

const double k_angles[] = {
    1e-4, 1e-2, 0.3, 1.0, std::numbers::pi / 2, 2.0, 3.0, std::numbers::pi - 1e-4, std::numbers::pi - 1e-5};

std::vector<scene::Medium> media() {
  const glm::vec3 coloured(0.02f, 0.3f, 4.0f), absorbing(0.0f, 0.1f, 0.5f);
  std::vector<scene::Medium> result{{.sigma_s = glm::vec3(0.1f), .sigma_a = glm::vec3(0.0f)},
                                    {.sigma_s = coloured, .sigma_a = absorbing}};
  result.push_back({.sigma_s = coloured, .sigma_a = absorbing, .phase = PhaseFunction::rayleigh});
  for (float g : {0.0f, 0.5f, -0.7f, 0.99f, -0.99f}) {
    result.push_back(
        {.sigma_s = coloured, .sigma_a = absorbing, .phase = PhaseFunction::henyey_greenstein, .g = g});
  }
  result.push_back({.sigma_s = coloured,
                    .sigma_a = absorbing,
                    .phase = PhaseFunction::hoffman_preetham,
                    .g = 0.9f,
                    .rayleigh_weight = 0.2f});
  return result;
}

std::string describe(const scene::Medium& medium, double D, double alpha) {
  return "phase " + std::to_string(static_cast<int>(medium.phase)) + ", g " + std::to_string(medium.g) +
         ", D " + std::to_string(D) + ", alpha " + std::to_string(alpha);
}

TEST(EmptyFog, EndlessRaysMatchTheIntegralOverDistance) {
  for (const scene::Medium& medium : media()) {
    for (double alpha : k_angles) {
      for (double D : {0.01, 3.0, 12.0}) {
        const scene::View view = one_pixel_view(D, alpha, medium);
        const AirlightImage image = Reference({}, view).exact();
        expect_near(image.radiance[0], airlight_over_distance(view, alpha, 0.0, k_infinity),
                    describe(medium, D, alpha));
      }
    }
  }
}

TEST(EmptyFog, RaysThatEndOnAWallMatchTheIntegralOverDistance) {
  const double D = 3.0;
  for (const scene::Medium& medium : media()) {
    for (double alpha : k_angles) {
      for (float distance : {0.001f, 2.5f, 40.0f}) {
        const auto d = static_cast<double>(distance);
        if (d < D * std::cos(alpha)) continue;  // the wall would shadow the ray
        const scene::View view = one_pixel_view(D, alpha, medium);
        const float half = 0.1f * distance;
        scene::Geometry wall;
        tests::add_quad(wall, {-half, -half, distance}, {2 * half, 0, 0}, {0, 2 * half, 0});
        const AirlightImage image = Reference(wall, view).exact();
        // Rays are single precision: the last 1e-7 of the light's distance before the wall may lie in its
        // shadow.
        expect_near(image.radiance[0], airlight_over_distance(view, alpha, 0.0, d),
                    describe(medium, d, alpha), k_tolerance + 3e-7 * D / d);
      }
    }
  }
}

TEST(EmptyFog, StraightAtTheLightIsTheAirlightAQuarterPixelAside) {
  const double quarter_pixel = 0.5 * std::tan(0.5 * glm::radians(0.01));
  for (const scene::Medium& medium : media()) {
    const glm::dvec3 expected =
        airlight_over_distance(one_pixel_view(3.0, quarter_pixel, medium), quarter_pixel, 0.0, k_infinity);
    for (double alpha : {0.0, 0.9 * quarter_pixel}) {
      const AirlightImage image = Reference({}, one_pixel_view(3.0, alpha, medium)).exact();
      expect_near(image.radiance[0], expected, describe(medium, 3.0, alpha));
    }
  }
}

TEST(EmptyFog, LightStraightBehindTheCamera) {
  for (const scene::Medium& medium : media()) {
    scene::View view = one_pixel_view(3.0, 0.0, medium);
    view.lights[0].position = {0, 0, -3};
    const AirlightImage image = Reference({}, view).exact();
    expect_near(image.radiance[0], airlight_over_distance(view, std::numbers::pi, 0.0, k_infinity),
                describe(medium, 3.0, std::numbers::pi));
  }
}

TEST(EmptyFog, MarchConvergesToTheIntegralOverDistance) {
  // The midpoint rule's error falls with the square of the step: 4096 steps leave less than 1e-5 of these,
  // and 5e-4 of a lobe where they begin to resolve it.
  for (const scene::Medium& medium : media()) {
    const double tolerance = std::abs(medium.g) > 0.9f ? 5e-4 : 1e-5;
    for (double alpha : {0.3, 2.0, 3.0, std::numbers::pi - 1e-5}) {
      const scene::View view = one_pixel_view(1.0, alpha, medium);
      const glm::dvec3 expected = airlight_over_distance(view, alpha, 0.0, k_infinity);
      for (RayMode mode : {RayMode::single, RayMode::packet}) {
        const glm::vec3 radiance = Reference({}, view).march(4096, mode).radiance[0];
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_NEAR(static_cast<double>(radiance[channel]) / expected[channel], 1.0, tolerance)
              << describe(medium, 1.0, alpha) << ", channel " << channel;
        }
      }
    }
  }
}

TEST(EmptyFog, AMarchOfFewStepsDoesNotMissANarrowLobe) {
  for (float g : {0.95f, -0.95f, 0.99f, -0.99f}) {
    for (double alpha : {0.003, 0.03}) {
      const scene::Medium medium{
          .sigma_s = glm::vec3(0.1f), .phase = PhaseFunction::henyey_greenstein, .g = g};
      const scene::View view = one_pixel_view(5.0, alpha, medium);
      const glm::dvec3 expected = airlight_over_distance(view, alpha, 0.0, k_infinity);
      for (int steps : {5, 64, 512}) {
        const glm::vec3 radiance = Reference({}, view).march(steps, RayMode::packet).radiance[0];
        EXPECT_NEAR(static_cast<double>(radiance.x) / expected.x, 1.0, 2e-3)
            << describe(medium, 5.0, alpha) << steps;
      }
    }
  }
}

TEST(EmptyFog, WithoutFogThereIsNoAirlight) {
  const scene::Medium vacuum{.sigma_s = glm::vec3(0.0f), .sigma_a = glm::vec3(0.0f)};
  const scene::Medium smoke{.sigma_s = glm::vec3(0.0f), .sigma_a = glm::vec3(1.0f)};
  for (const scene::Medium& medium : {vacuum, smoke}) {
    const Reference reference({}, one_pixel_view(3.0, 1.0, medium));
    EXPECT_EQ(reference.exact().radiance[0], glm::vec3(0.0f));
    EXPECT_EQ(reference.march(8, RayMode::packet).radiance[0], glm::vec3(0.0f));
  }
}

}  // namespace
}  // namespace airlight::reference
