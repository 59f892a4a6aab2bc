#include "reference/phase.h"

#include <gtest/gtest.h>

#include "unit/reference/fixtures.h"

namespace airlight::reference {
namespace {

using scene::PhaseFunction;

double phase_of(PhaseFunction function, float g, double cosine, float rayleigh_weight = 0.5f) {
  return phase({.phase = function, .g = g, .rayleigh_weight = rayleigh_weight}, cosine);
}

/// 2π ∫ p(cos θ) cosⁿθ d cos θ.
double moment(PhaseFunction function, float g, int n, float rayleigh_weight = 0.5f) {
  const auto integrand = [&](double cosine) {
    return 2 * std::numbers::pi * phase_of(function, g, cosine, rayleigh_weight) * std::pow(cosine, n);
  };
  return tests::integrate(integrand, -1.0, 1.0, 1e-12);
}

constexpr float k_lobes[] = {-0.99f, -0.7f, 0.0f, 0.5f, 0.9f, 0.999f};
constexpr float k_weights[] = {0.0f, 0.25f, 0.5f, 1.0f};

TEST(Phase, IntegratesToOneOverTheSphere) {
  EXPECT_NEAR(moment(PhaseFunction::isotropic, 0.0f, 0), 1.0, 1e-10);
  EXPECT_NEAR(moment(PhaseFunction::rayleigh, 0.0f, 0), 1.0, 1e-10);
  for (float g : k_lobes) {
    EXPECT_NEAR(moment(PhaseFunction::henyey_greenstein, g, 0), 1.0, 1e-9) << "g = " << g;
    for (float weight : k_weights)
      EXPECT_NEAR(moment(PhaseFunction::hoffman_preetham, g, 0, weight), 1.0, 1e-9) << g << " " << weight;
  }
}

TEST(Phase, HasTheMeanCosineThatItsParameterSays) {
  EXPECT_NEAR(moment(PhaseFunction::isotropic, 0.0f, 1), 0.0, 1e-10);
  EXPECT_NEAR(moment(PhaseFunction::rayleigh, 0.0f, 1), 0.0, 1e-10);
  for (float g : k_lobes) {
    const auto mean = static_cast<double>(g);
    EXPECT_NEAR(moment(PhaseFunction::henyey_greenstein, g, 1), mean, 1e-9) << "g = " << g;
    for (float weight : k_weights) {
      EXPECT_NEAR(moment(PhaseFunction::hoffman_preetham, g, 1, weight),
                  (1 - static_cast<double>(weight)) * mean, 1e-9)
          << g << " " << weight;
    }
  }
}

TEST(Phase, RayleighScattersTwiceAsMuchStraightAsSideways) {
  EXPECT_DOUBLE_EQ(phase_of(PhaseFunction::rayleigh, 0.0f, 1.0),
                   2 * phase_of(PhaseFunction::rayleigh, 0.0f, 0.0));
  EXPECT_DOUBLE_EQ(phase_of(PhaseFunction::rayleigh, 0.0f, -1.0),
                   phase_of(PhaseFunction::rayleigh, 0.0f, 1.0));
}

TEST(Phase, HoffmanPreethamAtTheEndsOfItsWeightIsOneOfItsParts) {
  for (double cosine : {-1.0, -0.3, 0.0, 0.8, 1.0}) {
    EXPECT_EQ(phase_of(PhaseFunction::hoffman_preetham, 0.6f, cosine, 0.0f),
              phase_of(PhaseFunction::henyey_greenstein, 0.6f, cosine));
    EXPECT_EQ(phase_of(PhaseFunction::hoffman_preetham, 0.6f, cosine, 1.0f),
              phase_of(PhaseFunction::rayleigh, 0.6f, cosine));
  }
}

}  // namespace
}  // namespace airlight::reference
