#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include <gtest/gtest.h>

#include "media/medium.h"
#include "support/random.h"

/// shaders/media/medium.glsl.
namespace airlight::shaders {
namespace {

using std::numbers::pi;

template <class Number>
double exact(Number value) {
  return static_cast<double>(value);
}

Angle single(double angle) {
  return Angle(static_cast<float>(angle));
}

/// ∫ f over [−1, 1] by Gauss–Legendre's two-point rule on cells that shrink towards both ends, where the
/// lobes of Henyey-Greenstein are.
template <class Function>
double over_cosines(const Function& f) {
  double sum = 0.0;
  const int cells = 20000;
  const auto place = [](double s) { return std::sin(0.5 * pi * s); };
  for (int i = 0; i < cells; ++i) {
    const double a = place(2.0 * i / cells - 1), b = place(2.0 * (i + 1) / cells - 1);
    const double middle = 0.5 * (a + b), offset = 0.5 * (b - a) / std::sqrt(3.0);
    sum += 0.5 * (b - a) * (f(middle - offset) + f(middle + offset));
  }
  return sum;
}

MediumBlock make_medium(glm::vec3 sigma_t, float g, float rayleigh_weight = 0.0f) {
  MediumBlock medium{};
  medium.sigma_s = sigma_t;
  medium.sigma_t = sigma_t;
  medium.g = g;
  medium.rayleigh_weight = rayleigh_weight;
  medium.top = k_no_top;
  return medium;
}

struct Phase {
  const char* name;
  uint kind;
  float g;
  double mean_cosine;
  float rayleigh_weight = 0.0f;

  float at(double cosine) const {
    return phase_function(kind, make_medium({}, g, rayleigh_weight),
                          static_cast<float>(std::sqrt(0.5 * (1 - cosine))),
                          static_cast<float>(std::sqrt(0.5 * (1 + cosine))));
  }
};

void PrintTo(const Phase& phase, std::ostream* stream) {
  *stream << phase.name << " " << phase.g << " " << phase.rayleigh_weight;
}

class PhaseFunction : public testing::TestWithParam<Phase> {};

/// 1 − g loses digits of a g of single precision; what is known of the g that is given in double.
double tolerance(const Phase& phase) {
  return 1e-6 + 6e-8 / (1.0 - std::abs(exact(phase.g)));
}

TEST_P(PhaseFunction, IntegratesToOneOverTheSphere) {
  const Phase& phase = GetParam();
  const double sum = 2 * pi * over_cosines([&](double cosine) { return exact(phase.at(cosine)); });
  EXPECT_NEAR(sum, 1.0, tolerance(phase));
}

TEST_P(PhaseFunction, HasTheMeanCosineG) {
  const Phase& phase = GetParam();
  const double mean = 2 * pi * over_cosines([&](double cosine) { return cosine * exact(phase.at(cosine)); });
  EXPECT_NEAR(mean, phase.mean_cosine, tolerance(phase));
}

TEST_P(PhaseFunction, IsPositive) {
  for (int i = 0; i <= 1000; ++i) {
    EXPECT_GT(GetParam().at(i / 500.0 - 1.0), 0.0f);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PhaseFunction,
                         testing::Values(Phase{"isotropic", k_isotropic, 0.0f, 0.0},
                                         Phase{"isotropic", k_isotropic, 0.7f, 0.0},
                                         Phase{"rayleigh", k_rayleigh, 0.0f, 0.0},
                                         Phase{"rayleigh", k_rayleigh, 0.7f, 0.0},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, 0.0f, 0.0},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, 0.5f, 0.5},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, -0.5f, -0.5},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, 0.9f, 0.9},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, 0.99f, 0.99},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, -0.99f, -0.99},
                                         Phase{"henyey_greenstein", k_henyey_greenstein, 0.999f, 0.999},
                                         Phase{"hoffman_preetham", k_hoffman_preetham, 0.0f, 0.0, 0.3f},
                                         Phase{"hoffman_preetham", k_hoffman_preetham, 0.5f, 0.375, 0.25f},
                                         Phase{"hoffman_preetham", k_hoffman_preetham, -0.5f, -0.25, 0.5f},
                                         Phase{"hoffman_preetham", k_hoffman_preetham, 0.9f, 0.09, 0.9f}));

TEST(PhaseValues, AreThoseOfTheBooks) {
  EXPECT_FLOAT_EQ((Phase{"", k_isotropic, 0.0f, 0}.at(0.3)), static_cast<float>(1 / (4 * pi)));
  EXPECT_FLOAT_EQ((Phase{"", k_rayleigh, 0.0f, 0}.at(1)), static_cast<float>(3 / (8 * pi)));
  EXPECT_FLOAT_EQ((Phase{"", k_rayleigh, 0.0f, 0}.at(0)), static_cast<float>(3 / (16 * pi)));
  EXPECT_FLOAT_EQ((Phase{"", k_henyey_greenstein, 0.0f, 0}.at(0.7)), static_cast<float>(1 / (4 * pi)));
  EXPECT_FLOAT_EQ((Phase{"", k_henyey_greenstein, 0.5f, 0}.at(1)),
                  static_cast<float>(0.75 / (4 * pi * 0.125)));
  EXPECT_FLOAT_EQ((Phase{"", k_henyey_greenstein, 0.5f, 0}.at(-1)),
                  static_cast<float>(0.75 / (4 * pi * 3.375)));
  EXPECT_FLOAT_EQ((Phase{"", k_hoffman_preetham, 0.5f, 0, 0.25f}.at(1)),
                  static_cast<float>(0.75 * 0.75 / (4 * pi * 0.125) + 0.25 * 3 / (8 * pi)));
}

TEST(PhaseValues, OfHoffmanPreethamAtTheEndsOfItsWeightAreThoseOfItsParts) {
  for (double cosine : {-1.0, -0.3, 0.0, 0.8, 1.0}) {
    EXPECT_EQ((Phase{"", k_hoffman_preetham, 0.6f, 0, 0.0f}.at(cosine)),
              (Phase{"", k_henyey_greenstein, 0.6f, 0}.at(cosine)));
    EXPECT_EQ((Phase{"", k_hoffman_preetham, 0.6f, 0, 1.0f}.at(cosine)),
              (Phase{"", k_rayleigh, 0.6f, 0}.at(cosine)));
  }
}

double phase_in_double(uint kind, const MediumBlock& medium, double cosine) {
  const double g = exact(medium.g), weight = exact(medium.rayleigh_weight);
  const double rayleigh = 3 / (16 * pi) * (1 + cosine * cosine);
  const double henyey_greenstein = (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  if (kind == k_rayleigh) return rayleigh;
  if (kind == k_henyey_greenstein) return henyey_greenstein;
  if (kind == k_hoffman_preetham) return (1 - weight) * henyey_greenstein + weight * rayleigh;
  return 1 / (4 * pi);
}

double integrand_in_double(double D, double sigma, uint kind, const MediumBlock& medium, double complement,
                           double phi) {
  const double path = D * std::sin(0.5 * (complement + phi)) / std::sin(0.5 * (complement - phi));
  return std::exp(-sigma * path) * phase_in_double(kind, medium, -std::cos(complement - phi));
}

TEST(AirlightIntegrand, EqualsTheDoublePrecisionOne) {
  tests::Random random(15);
  for (int i = 0; i < 30000; ++i) {
    EpipolarBlock space{};
    space.distance = static_cast<float>(random.logarithmic(0.1, 100));
    space.inverse_distance = 1.0f / space.distance;
    const uint kind = random.bits() % 4;
    const MediumBlock medium = make_medium(glm::vec3(random.logarithmic(1e-4, 0.1), 0.01, 0.0),
                                           static_cast<float>(random.uniform(-0.8, 0.8)), 0.4f);
    const Angle complement = single(random.uniform(1e-3, 3.14));
    const Angle phi = complement * static_cast<float>(random.uniform(0.0, 0.99));
    const glm::vec3 value = airlight_integrand(space, medium, kind, complement, phi);
    for (int channel = 0; channel < 3; ++channel) {
      const double sigma = exact(medium.sigma_t[channel]);
      const double expected =
          integrand_in_double(exact(space.distance), sigma, kind, medium, exact(complement), exact(phi));
      if (expected < 1e-30) continue;
      const double depth = -std::log(expected * 4 * pi);
      // e^{−x} turns a relative error of x into one of x times as much.
      EXPECT_NEAR(exact(value[channel]) / expected, 1.0, 3e-6 + 1e-6 * std::abs(depth))
          << complement << " " << phi;
    }
  }
}

TEST(AirlightIntegrand, IsZeroAtInfinityWhereTheMediumAbsorbs) {
  EpipolarBlock space{};
  space.distance = 2.0f;
  space.inverse_distance = 1.0f / space.distance;
  const MediumBlock medium = make_medium({0.1f, 0.2f, 0.3f}, 0.0f);
  for (const Angle complement : {Angle(1e-5f), Angle(1.0f), Angle(3.0f)}) {
    for (const Angle phi : {complement, 1.1f * complement}) {
      const glm::vec3 value = airlight_integrand(space, medium, k_isotropic, complement, phi);
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_GE(value[channel], 0.0f);
        EXPECT_LT(value[channel], 1e-30f);
      }
    }
  }
}

TEST(IntegrateCell, MatchesHighOrderQuadratureOnTheCellsOfAGrid) {
  // Two points integrate cubics exactly: the error of a cell of width h is h⁴/4320 of its fourth derivative.
  tests::Random random(16);
  for (int i = 0; i < 3000; ++i) {
    EpipolarBlock space{};
    space.distance = static_cast<float>(random.logarithmic(0.5, 20));
    space.inverse_distance = 1.0f / space.distance;
    const uint kind = random.bits() % 4;
    const MediumBlock medium = make_medium(glm::vec3(static_cast<float>(random.logarithmic(1e-3, 0.5))),
                                           static_cast<float>(random.uniform(-0.7, 0.7)), 0.4f);
    const double complement = random.uniform(0.5, 3.1);
    const double width = pi / 512;
    const double from = random.uniform(0, 0.9) * complement, to = std::min(from + width, 0.97 * complement);
    if (to <= from) continue;
    const Angle single_from = single(from), single_to = single(to);
    const float value = integrate_cell(space, medium, kind, single(complement), single_from, single_to).x;
    double expected = 0.0;
    const int panels = 64;
    const double h = (exact(single_to) - exact(single_from)) / panels;
    for (int panel = 0; panel < panels; ++panel) {
      const double middle = exact(single_from) + (panel + 0.5) * h, offset = 0.5 * h / std::sqrt(3.0);
      for (double phi : {middle - offset, middle + offset}) {
        expected += 0.5 * h *
                    integrand_in_double(exact(space.distance), exact(medium.sigma_t.x), kind, medium,
                                        exact(single(complement)), phi);
      }
    }
    if (expected < 1e-20) continue;
    // Relative to the largest cell there is: light that has travelled far changes fast within a cell, but is
    // little of it.
    EXPECT_NEAR(exact(value), expected, 2e-5 * expected + 1e-6 * width / (4 * pi))
        << complement << " " << from;
  }
}

TEST(IntegrateCell, SumsToTheIntegralOfTheWholeRay) {
  tests::Random random(17);
  const double width = pi / 512;
  for (int i = 0; i < 1000; ++i) {
    EpipolarBlock space{};
    space.distance = 1.0f;
    space.inverse_distance = 1.0f / space.distance;
    const uint kind = random.bits() % 4;
    const MediumBlock medium = make_medium(glm::vec3(static_cast<float>(random.logarithmic(1e-3, 3))), 0.6f);
    const Angle complement = single(random.logarithmic(1e-3, 3.1));
    double sum = 0.0;
    for (int k = 0; k * width < exact(complement); ++k) {
      const Angle from = single(k * width), to = min(single((k + 1) * width), complement);
      sum += exact(integrate_cell(space, medium, kind, complement, from, to).x);
    }
    double expected = 0.0;
    const int panels = 4000;
    for (int panel = 0; panel < panels; ++panel) {
      const double h = exact(complement) / panels, middle = (panel + 0.5) * h,
                   offset = 0.5 * h / std::sqrt(3.0);
      for (double phi : {middle - offset, middle + offset}) {
        expected +=
            0.5 * h * integrand_in_double(1.0, exact(medium.sigma_t.x), kind, medium, exact(complement), phi);
      }
    }
    // The last cell of an endless ray ends where the path becomes infinite, a singularity that no polynomial
    // follows: it may err by half a cell.
    const double cells = exact(complement) / width;
    EXPECT_NEAR(sum / expected, 1.0, 0.5 / (1 + cells)) << complement << " " << medium.sigma_t.x;
  }
}

/// ∫ by panels that halve towards both ends of the ray, where lobes are, each of 40 midpoints.
double run_in_double(double D, double sigma, uint kind, const MediumBlock& medium, double complement,
                     double from, double to) {
  double sum = 0.0;
  const auto panel = [&](double a, double b) {
    a = std::max(a, from), b = std::min(b, to);
    for (int i = 0; i < 40 && a < b; ++i)
      sum += (b - a) / 40 *
             integrand_in_double(D, sigma, kind, medium, complement, a + (i + 0.5) * (b - a) / 40);
  };
  const double middle = 0.5 * complement;
  for (int i = 0; i < 50; ++i) {
    panel(middle * std::pow(0.6, i + 1), middle * std::pow(0.6, i));
    panel(complement - middle * std::pow(0.6, i), complement - middle * std::pow(0.6, i + 1));
  }
  return sum;
}

TEST(IntegrateRun, FollowsNarrowLobesAndHeavyExtinction) {
  for (float g : {0.0f, 0.5f, -0.8f, 0.95f, -0.95f, 0.99f, -0.99f, 0.995f, -0.995f}) {
    for (float sigma : {0.0f, 0.01f, 1.0f, 10.0f, 35.0f}) {
      for (double complement : {pi - 1e-4, pi - 3e-3, pi - 0.1, 2.0, 0.5, 0.03, 1e-3, 1e-5}) {
        EpipolarBlock space{};
        space.distance = 2.0f;
        space.inverse_distance = 1.0f / space.distance;
        const MediumBlock medium = make_medium(glm::vec3(sigma), g, 0.3f);
        for (uint kind : {k_henyey_greenstein, k_hoffman_preetham}) {
          const auto run = [&](double from, double to) {
            return exact(integrate_run(space, medium, kind, single(complement), single(from), single(to)).x);
          };
          const auto expected = [&](double from, double to) {
            return run_in_double(2.0, exact(sigma), kind, medium, exact(single(complement)),
                                 exact(single(from)), exact(single(to)));
          };
          const double whole = expected(0.0, complement);
          // Two points a step, and π − α of single precision within the lobe.
          EXPECT_NEAR(run(0.0, complement) / whole, 1.0, 4e-3)
              << "g " << g << ", sigma " << sigma << ", complement " << complement << ", kind " << kind;
          for (double middle : {0.001, 0.01, 0.5, 0.99, 0.999}) {
            EXPECT_NEAR(run(0.0, middle * complement), expected(0.0, middle * complement), 4e-3 * whole);
            EXPECT_NEAR(run(middle * complement, complement), expected(middle * complement, complement),
                        4e-3 * whole);
          }
        }
      }
    }
  }
}

TEST(IntegrateRun, IsZeroWhereSinglePrecisionHasNoSuchNumber) {
  EpipolarBlock space{};
  space.distance = 5.0f;
  space.inverse_distance = 1.0f / space.distance;
  for (float sigma : {20.0f, 1000.0f, 1e38f}) {
    const MediumBlock medium = make_medium(glm::vec3(sigma), 0.0f);
    for (float complement : {1e-5f, 1.0f, 3.0f, k_pi})
      EXPECT_EQ(integrate_run(space, medium, k_isotropic, Angle(complement), Angle(0.0f), Angle(complement)),
                glm::vec3(0.0f));
  }
}

TEST(TablePlace, GrowsFromZeroToTwoAndIsTheInverseOfComplementAt) {
  EXPECT_EQ(table_place(Angle(0.0f)), 0.0f);
  EXPECT_NEAR(table_place(k_half_turn), 2.0f, 1e-6f);
  float last = -1.0f;
  for (int i = 0; i <= 20000; ++i) {
    const float alpha = k_pi * static_cast<float>(i) / 20000;
    const float place = table_place(Angle(alpha));
    EXPECT_GT(place, last);
    EXPECT_NEAR(exact(complement_at(place)), exact(k_pi - alpha), 1e-6) << alpha;
    last = place;
  }
}

TEST(AirlightScale, IsTheFactorBeforeTheIntegral) {
  EpipolarBlock space{};
  space.distance = 4.0f;
  space.inverse_distance = 1.0f / space.distance;
  const MediumBlock medium = make_medium({0.5f, 0.25f, 0.125f}, 0.0f);
  LightBlock light{};
  light.is_near = 1.0f;
  light.intensity = {1, 2, 3};
  const glm::vec3 scale = airlight_scale(space, light, medium, 0.5f);
  EXPECT_FLOAT_EQ(scale.x, 0.25f);
  EXPECT_FLOAT_EQ(scale.y, 0.25f);
  EXPECT_FLOAT_EQ(scale.z, 0.1875f);
}

}  // namespace
}  // namespace airlight::shaders
