#include "reference/phase.h"

#include <gtest/gtest.h>

#include "unit/reference/fixtures.h"

namespace airlight::reference {
namespace {

using scene::PhaseFunction;

/// 2π ∫ p(cos θ) cosⁿθ d cos θ.
double moment(PhaseFunction function, double g, int n) {
  const auto integrand = [&](double cosine) {
    return 2 * std::numbers::pi * phase(function, g, cosine) * std::pow(cosine, n);
  };
  return tests::integrate(integrand, -1.0, 1.0, 1e-12);
}

TEST(Phase, IntegratesToOneOverTheSphere) {
  EXPECT_NEAR(moment(PhaseFunction::isotropic, 0.0, 0), 1.0, 1e-10);
  EXPECT_NEAR(moment(PhaseFunction::rayleigh, 0.0, 0), 1.0, 1e-10);
  for (double g : {-0.99, -0.7, 0.0, 0.5, 0.9, 0.999}) {
    EXPECT_NEAR(moment(PhaseFunction::henyey_greenstein, g, 0), 1.0, 1e-9) << "g = " << g;
  }
}

TEST(Phase, HasTheMeanCosineThatItsParameterSays) {
  EXPECT_NEAR(moment(PhaseFunction::isotropic, 0.0, 1), 0.0, 1e-10);
  EXPECT_NEAR(moment(PhaseFunction::rayleigh, 0.0, 1), 0.0, 1e-10);
  for (double g : {-0.99, -0.7, 0.0, 0.5, 0.9, 0.999}) {
    EXPECT_NEAR(moment(PhaseFunction::henyey_greenstein, g, 1), g, 1e-9) << "g = " << g;
  }
}

TEST(Phase, RayleighScattersTwiceAsMuchStraightAsSideways) {
  EXPECT_DOUBLE_EQ(phase(PhaseFunction::rayleigh, 0.0, 1.0), 2 * phase(PhaseFunction::rayleigh, 0.0, 0.0));
  EXPECT_DOUBLE_EQ(phase(PhaseFunction::rayleigh, 0.0, -1.0), phase(PhaseFunction::rayleigh, 0.0, 1.0));
}

}  // namespace
}  // namespace airlight::reference
