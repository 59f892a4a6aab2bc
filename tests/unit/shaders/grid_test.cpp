#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "epipolar/space_math.h"
#include "support/grid_bits.h"
#include "support/random.h"

/// shaders/epipolar/grid.glsl: which cell holds what.
namespace airlight::shaders {
namespace {

constexpr Angle k_turn = 2.0f * k_half_turn;

float number(Angle angle) {
  return static_cast<float>(angle);
}

template <class Number>
double exact(Number value) {
  return static_cast<double>(value);
}

Cell cells_from_start(uint boundary, float further = 0.0f) {
  return Cell(static_cast<float>(boundary) + further);
}

/// The same direction within half a turn of 0.
Angle wrapped_about_zero(Angle angle) {
  return Angle(std::remainder(number(angle), number(k_turn)));
}

EpipolarBlock make_range(float alpha_min, float alpha_max, uint count, float spacing = k_equal_alpha) {
  EpipolarBlock space{};
  space.alpha_min = Angle(alpha_min);
  space.alpha_spacing = spacing;
  space.alpha_step = spaced_alpha(space, Angle(alpha_max)) / static_cast<float>(count);
  return space;
}

/// θ cells of a range around `middle`.
EpipolarBlock theta_space(Angle middle, Angle half, uint count, float growth = 0.0f) {
  EpipolarBlock space{};
  space.theta_middle = middle;
  space.theta_half = half;
  space.theta_step = 2.0f * half / static_cast<float>(count);
  space.theta_growth = growth;
  return space;
}

class ThetaCell : public testing::TestWithParam<uint> {};

TEST_P(ThetaCell, OfEachCentreIsThatCell) {
  const uint count = GetParam();
  for (const Angle middle : {Angle(0.0f), Angle(1.0f), Angle(-3.1f), k_half_turn}) {
    for (const Angle half : {k_half_turn, Angle(1.4f), Angle(0.01f)}) {
      const EpipolarBlock space = theta_space(middle, half, count);
      // The centres of narrow cells are not told from their borders in single precision.
      if (space.theta_step < Angle(1e-5f)) continue;
      for (uint j = 0; j < count; ++j) {
        const Angle theta = wrapped_about_zero(theta_centre(space, j));
        EXPECT_EQ(theta_cell(space, theta, count), j) << middle << " ± " << half;
      }
    }
  }
}

TEST_P(ThetaCell, OfAFittedTurnIsInvertedByItsCentre) {
  const uint count = GetParam();
  for (const float growth : {0.1f, 0.5f, 0.8f}) {
    const EpipolarBlock space = theta_space(Angle(1.0f), k_half_turn, count, growth);
    if ((1.0f - growth) * space.theta_step < Angle(1e-5f)) continue;
    Angle before = -k_half_turn;
    for (uint j = 0; j < count; ++j) {
      const Angle x = theta_of_plane(space, cells_from_start(j, 0.5f));
      EXPECT_GT(x, before);
      before = x;
      EXPECT_NEAR(static_cast<float>(plane_of_theta(space, x)), static_cast<float>(j) + 0.5f,
                  Angle(2e-6f) / space.theta_step);
      const Angle theta = wrapped_about_zero(theta_centre(space, j));
      EXPECT_EQ(theta_cell(space, theta, count), j);
      // A little beside the centre, it is found again.
      const Angle beside = wrapped_about_zero(theta + 0.2f * space.theta_step);
      const float step = number(space.theta_step);
      EXPECT_NEAR(number(theta_to_centre(space, beside, j)), -0.2f * step, 4e-6f + 0.3f * step * step);
    }
    EXPECT_NEAR(number(theta_of_plane(space, Cell(0.0f))), -k_pi, 2e-6f);
    EXPECT_NEAR(number(theta_of_plane(space, cells_from_start(count))), k_pi, 2e-6f);
  }
}

TEST_P(ThetaCell, WrapsAtPi) {
  const uint count = GetParam();
  const EpipolarBlock space = theta_space(Angle(0.0f), k_half_turn, count);
  EXPECT_EQ(theta_cell(space, -k_half_turn, count), 0u);
  EXPECT_EQ(theta_cell(space, k_half_turn, count), count - 1);
  // The first and the last centre are one step apart across the seam.
  const Angle across = theta_centre(space, 0) + k_turn - theta_centre(space, count - 1);
  EXPECT_NEAR(number(across), number(space.theta_step), 1e-6f);
}

TEST_P(ThetaCell, HoldsWhatIsNearerToItsCentreThanToOthers) {
  tests::Random random(10);
  const uint count = GetParam();
  for (int i = 0; i < 10000; ++i) {
    const Angle half(static_cast<float>(random.uniform(0.1, 3.14159265)));
    const Angle middle(static_cast<float>(random.uniform(-3.14159265, 3.14159265)));
    const EpipolarBlock space = theta_space(middle, half, count);
    const Angle from_middle = static_cast<float>(random.uniform(-1.0, 1.0)) * half;
    const Angle theta = wrapped_about_zero(space.theta_middle + from_middle);
    const uint j = theta_cell(space, theta, count);
    ASSERT_LT(j, count);
    const Angle from_centre = wrapped_about_zero(theta - theta_centre(space, j));
    // Sums of angles carry roundings of 2⁻²² each.
    EXPECT_LE(std::abs(number(from_centre)), 0.5f * number(space.theta_step) + 2e-6f);
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, ThetaCell, testing::Values(1u, 2u, 3u, 64u, 333u, 2048u, 16384u));

/// The range of α and how it is cut: as epipolar_block asks for it, and between.
struct AlphaRange {
  float lower, upper, spacing;
};

class AlphaCells : public testing::TestWithParam<AlphaRange> {};

TEST_P(AlphaCells, CoverTheRange) {
  const auto& [lower, upper, spacing] = GetParam();
  for (uint count : {1u, 5u, 512u, 4096u}) {
    const EpipolarBlock space = make_range(lower, upper, count, spacing);
    EXPECT_NEAR(number(alpha_of_cell(space, Cell(0.0f))), lower, 1e-6f);
    EXPECT_NEAR(number(alpha_of_cell(space, cells_from_start(count))), upper, 2e-6f);
  }
}

TEST_P(AlphaCells, AreThoseOfDoublePrecision) {
  const auto& [lower, upper, spacing] = GetParam();
  tests::Random random(13);
  const EpipolarBlock space = make_range(lower, upper, 512, spacing);
  for (int n = 0; n < 10000; ++n) {
    const auto alpha = static_cast<float>(random.uniform(exact(lower), exact(upper)));
    const double cell = tests::cells_of_alpha(space, exact(alpha));
    // A root and the start's are right to 1.2e-7 and 2.4e-7 or less.
    EXPECT_NEAR(exact(cell_of_alpha(space, Angle(alpha))), cell,
                5e-7 / exact(space.alpha_step) + 1e-6 * cell);
    EXPECT_NEAR(exact(alpha_of_cell(space, Cell(static_cast<float>(cell)))), exact(alpha), 3e-6);
  }
}

TEST_P(AlphaCells, AreNarrowWhereTheirRootIsSmall) {
  const auto& [lower, upper, spacing] = GetParam();
  const EpipolarBlock space = make_range(lower, upper, 64, spacing);
  for (uint i = 0; i < 64; ++i) {
    const double from = exact(alpha_of_cell(space, cells_from_start(i))),
                 to = exact(alpha_of_cell(space, cells_from_start(i + 1)));
    const double middle = 0.5 * (from + to);
    // dα = 2 √α d√α, where the middle of a cell stands for the mean of its borders' roots.
    const double slope = spacing == k_root_of_alpha        ? std::sqrt(from) + std::sqrt(to)
                         : spacing == k_root_of_complement ? std::sqrt(k_pi - from) + std::sqrt(k_pi - to)
                                                           : 1.0;
    EXPECT_NEAR(to - from, slope * exact(space.alpha_step), 2e-6) << middle;
  }
}

TEST_P(AlphaCells, OfEachCentreAreThatCell) {
  const auto& [lower, upper, spacing] = GetParam();
  for (uint count : {1u, 5u, 512u, 4096u}) {
    const EpipolarBlock space = make_range(lower, upper, count, spacing);
    for (uint i = 0; i < count; ++i) {
      const Angle from = alpha_of_cell(space, cells_from_start(i)),
                  centre = alpha_of_cell(space, cells_from_start(i, 0.5f));
      if (centre - from < Angle(1e-6f)) continue;  // what single precision tells apart near π
      EXPECT_EQ(alpha_cell(space, centre, count), i);
    }
  }
}

TEST_P(AlphaCells, OfTheFirstInShadowTheCentreLiesBehindTheOccluderAndTheOneBeforeDoesNot) {
  const auto& [lower, upper, spacing] = GetParam();
  tests::Random random(11);
  const uint count = 512;
  const EpipolarBlock space = make_range(lower, upper, count, spacing);
  for (int n = 0; n < 10000; ++n) {
    const Angle alpha(static_cast<float>(random.uniform(exact(lower), exact(upper))));
    const uint i = first_shadowed_cell(space, alpha, count);
    EXPECT_GE(alpha_of_cell(space, cells_from_start(i, 0.5f)), alpha - Angle(2e-6f));
    if (i > 0) {
      EXPECT_LE(alpha_of_cell(space, cells_from_start(i - 1, 0.5f)), alpha + Angle(2e-6f));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spacings, AlphaCells,
                         testing::Values(AlphaRange{0.7f, 1.9f, k_equal_alpha},
                                         AlphaRange{0.0f, 3.1f, k_equal_alpha},
                                         AlphaRange{0.0f, 0.6f, k_root_of_alpha},
                                         AlphaRange{0.2f, 1.9f, k_root_of_alpha},
                                         AlphaRange{2.4f, k_pi, k_root_of_complement},
                                         AlphaRange{1.0f, 3.0f, k_root_of_complement}));

TEST(AlphaCell, IsTheNearestOutsideTheRange) {
  const EpipolarBlock space = make_range(0.7f, 1.9f, 16);
  EXPECT_EQ(alpha_cell(space, Angle(0.0f), 16), 0u);
  EXPECT_EQ(alpha_cell(space, Angle(0.7f), 16), 0u);
  EXPECT_EQ(alpha_cell(space, Angle(1.9f), 16), 15u);
  EXPECT_EQ(alpha_cell(space, Angle(3.1f), 16), 15u);
}

TEST(FirstShadowedCell, StartsAtTheNearestBoundary) {
  const EpipolarBlock space = make_range(1.0f, 2.0f, 10);
  const auto at = [&](float cells) { return first_shadowed_cell(space, Angle(1.0f + 0.1f * cells), 10); };
  // An occluder within half a cell of boundary i makes cell i the first whose centre is dark: its centre, at
  // i + ½, is not before the occluder, and that of cell i − 1 is.
  EXPECT_EQ(at(0.0f), 0u);
  EXPECT_EQ(at(0.4f), 0u);
  EXPECT_EQ(at(0.6f), 1u);
  EXPECT_EQ(at(1.4f), 1u);
  EXPECT_EQ(at(1.6f), 2u);
  EXPECT_EQ(at(9.4f), 9u);
}

TEST(FirstShadowedCell, AnOccluderNearerTheAxisThanTheRangeShadowsAllOfIt) {
  const EpipolarBlock space = make_range(1.0f, 2.0f, 10);
  EXPECT_EQ(first_shadowed_cell(space, Angle(0.0f), 10), 0u);
  EXPECT_EQ(first_shadowed_cell(space, Angle(0.9f), 10), 0u);
}

TEST(FirstShadowedCell, AnOccluderBeyondTheRangeShadowsNone) {
  const EpipolarBlock space = make_range(1.0f, 2.0f, 10);
  EXPECT_EQ(first_shadowed_cell(space, Angle(1.96f), 10), 10u);
  EXPECT_EQ(first_shadowed_cell(space, Angle(2.0f), 10), 10u);
  EXPECT_EQ(first_shadowed_cell(space, Angle(3.0f), 10), 10u);
}

TEST(PhiCells, CoverTheRangeAndGrowFromTheFirstToTheLast) {
  for (float growth : {0.0f, 0.5f, 4.0f}) {
    const PhiCells cells = shared_cells(Angle(2.0f), growth, Cell(256.0f));
    EXPECT_EQ(phi_of_cell(cells, Cell(0.0f)), Angle(0.0f));
    EXPECT_FLOAT_EQ(number(phi_of_cell(cells, Cell(256.0f))), 2.0f);
    const Angle first = phi_of_cell(cells, Cell(1.0f)),
                last = phi_of_cell(cells, Cell(256.0f)) - phi_of_cell(cells, Cell(255.0f));
    EXPECT_NEAR(last / first, 1.0f + 2.0f * growth, 0.05f * (1.0f + growth)) << "1 + 2c, to a cell's width";
    for (uint k = 0; k < 256; ++k)
      EXPECT_GT(phi_of_cell(cells, cells_from_start(k + 1)), phi_of_cell(cells, cells_from_start(k)));
  }
}

TEST(PhiCells, WithoutGrowthAreEqual) {
  const PhiCells cells = shared_cells(Angle(3.0f), 0.0f, Cell(128.0f));
  for (float k = 0.0f; k <= 128.0f; k += 0.5f)
    EXPECT_FLOAT_EQ(number(phi_of_cell(cells, Cell(k))), 3.0f * k / 128.0f);
}

TEST(PhiCells, AreFoundAgainByTheirPhi) {
  tests::Random random(12);
  for (int i = 0; i < 20000; ++i) {
    const PhiCells cells = shared_cells(Angle(static_cast<float>(random.uniform(1e-3, 3.14))),
                                        static_cast<float>(random.uniform(0, 4)), Cell(512.0f));
    const auto cell = static_cast<float>(random.uniform(0, 512));
    EXPECT_NEAR(static_cast<float>(cell_of_phi(cells, phi_of_cell(cells, Cell(cell)))), cell,
                3e-6f * cell + 1e-30f);
  }
  const PhiCells cells = shared_cells(Angle(1.0f), 2.0f, Cell(512.0f));
  EXPECT_EQ(cell_of_phi(cells, Angle(0.0f)), Cell(0.0f));
  EXPECT_FLOAT_EQ(static_cast<float>(cell_of_phi(cells, Angle(1.0f))), 512.0f);
}

TEST(OwnCells, CutARangeOfTheSharedOnes) {
  tests::Random random(14);
  for (int i = 0; i < 5000; ++i) {
    const auto phi_max = static_cast<float>(random.logarithmic(1e-3, 100.0));
    const auto growth = static_cast<float>(random.uniform(0, 4));
    const auto lower = static_cast<float>(random.uniform(0.0, 0.9)) * phi_max;
    const float upper = lower + static_cast<float>(random.uniform(0.05, 1.0)) * (phi_max - lower);
    const PhiCells shared = shared_cells(Angle(phi_max), growth, Cell(256.0f));
    const PhiCells own = own_cells(Angle(phi_max), growth, Cell(256.0f), Angle(lower), Angle(upper));
    EXPECT_NEAR(number(phi_of_cell(own, Cell(0.0f))), lower, 3e-6f * phi_max);
    EXPECT_NEAR(number(phi_of_cell(own, Cell(256.0f))), upper, 3e-6f * phi_max);
    // Equal in what the shared ones are equal in.
    const auto shared_at = [&](float cell) {
      return static_cast<float>(cell_of_phi(shared, phi_of_cell(own, Cell(cell))));
    };
    const float width = (shared_at(256.0f) - shared_at(0.0f)) / 256.0f;
    const auto cell = static_cast<float>(random.uniform(0, 256));
    EXPECT_NEAR(shared_at(cell), shared_at(0.0f) + width * cell, 2e-3f);
    // Found again, to what single precision leaves of a place, in cells.
    EXPECT_NEAR(static_cast<float>(cell_of_phi(own, phi_of_cell(own, Cell(cell)))), cell,
                2e-6f / own.per_cell);
    // What lies outside of them is before the first or behind the last.
    EXPECT_LT(cell_of_phi(own, Angle(lower - 1e-2f * phi_max)), Cell(0.0f));
    EXPECT_GT(cell_of_phi(own, Angle(upper + 1e-2f * phi_max)), Cell(256.0f));
  }
}

TEST(OwnCells, OfTheWholeRangeAreTheSharedOnes) {
  const PhiCells shared = shared_cells(Angle(2.0f), 1.5f, Cell(512.0f));
  const PhiCells own = own_cells(Angle(2.0f), 1.5f, Cell(512.0f), Angle(0.0f), Angle(2.0f));
  EXPECT_EQ(own.first, 0.0f);
  EXPECT_FLOAT_EQ(own.per_cell, shared.per_cell);
}

TEST(OwnCells, OfAnEmptyRangeAreNarrowAndFinite) {
  for (const Angle at : {Angle(0.0f), Angle(1.0f), Angle(2.0f)}) {
    for (const Angle upper : {at, 0.5f * at}) {
      const PhiCells own = own_cells(Angle(2.0f), 1.5f, Cell(128.0f), at, upper);
      EXPECT_LT(number(phi_of_cell(own, Cell(128.0f)) - phi_of_cell(own, Cell(0.0f))), 2e-5f);
      for (const float phi : {0.0f, 0.5f, 1.0f, 2.0f, 1e30f}) {
        EXPECT_TRUE(std::isfinite(static_cast<float>(cell_of_phi(own, Angle(phi))))) << phi;
      }
      EXPECT_LE(cell_of_phi(own, at - Angle(0.1f)), Cell(0.0f));
      EXPECT_GE(cell_of_phi(own, at + Angle(0.1f)), Cell(128.0f));
    }
  }
}

TEST(GridWord, EveryWordHasAPlaceOfItsOwn) {
  const uint alpha_count = 5, theta_count = 3, words = 8;
  std::vector<int> used(alpha_count * theta_count * words, 0);
  for (uint j = 0; j < theta_count; ++j) {
    for (uint i = 0; i < alpha_count; ++i) {
      for (uint word = 0; word < words; ++word) ++used.at(grid_word(i, j, word, alpha_count, words));
    }
  }
  for (int count : used) EXPECT_EQ(count, 1);
  EXPECT_EQ(grid_word(0, 0, 1, alpha_count, words), 1u) << "neighbours in φ are neighbours in memory";
  EXPECT_EQ(grid_word(1, 0, 0, alpha_count, words), words) << "then those in α";
}

}  // namespace
}  // namespace airlight::shaders
