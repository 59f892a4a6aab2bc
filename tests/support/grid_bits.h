#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "epipolar/grid.h"
#include "epipolar/space.h"

/// The grid on the CPU, in double precision and apart from the shaders.
namespace airlight::tests {

/// A word that no scan writes, for a grid to hold before one.
inline constexpr std::uint32_t k_rubbish = 0xdeadbeef;

/// How many bits are set.
inline std::size_t count_set(std::span<const std::uint32_t> words) {
  std::size_t set = 0;
  for (const std::uint32_t word : words) set += static_cast<std::size_t>(std::popcount(word));
  return set;
}

/// The bit of voxel (α_i, θ_j, φ_k).
inline bool is_set(std::span<const std::uint32_t> words, const epipolar::Resolution& n, int i, int j, int k) {
  const auto ray =
      static_cast<std::size_t>(j) * static_cast<std::size_t>(n.alpha) + static_cast<std::size_t>(i);
  const std::size_t at = ray * static_cast<std::size_t>(n.phi) + static_cast<std::size_t>(k);
  return (words[at / 32] >> at % 32 & 1u) != 0;
}

/// α in what its cells are equal in.
inline double spaced_alpha(const shaders::EpipolarBlock& space, double alpha) {
  if (space.alpha_spacing == shaders::k_root_of_alpha) return std::sqrt(alpha);
  if (space.alpha_spacing == shaders::k_root_of_complement)
    return -std::sqrt(std::max(static_cast<double>(shaders::k_pi) - alpha, 0.0));
  return alpha;
}

/// α in cells: cell i reaches from i to i + 1.
inline double cells_of_alpha(const shaders::EpipolarBlock& space, double alpha) {
  return (spaced_alpha(space, alpha) - spaced_alpha(space, static_cast<double>(space.alpha_min))) /
         static_cast<double>(space.alpha_step);
}

/// Its inverse.
inline double alpha_of_cells(const shaders::EpipolarBlock& space, double cells) {
  const double spaced = spaced_alpha(space, static_cast<double>(space.alpha_min)) +
                        cells * static_cast<double>(space.alpha_step);
  if (space.alpha_spacing == shaders::k_root_of_alpha) return spaced * spaced;
  if (space.alpha_spacing == shaders::k_root_of_complement)
    return static_cast<double>(shaders::k_pi) - spaced * spaced;
  return spaced;
}

/// θ in planes.
inline double cells_of_theta(const shaders::EpipolarBlock& space, double theta) {
  const double from_middle =
      std::remainder(theta - static_cast<double>(space.theta_middle), 2 * std::numbers::pi);
  return (from_middle + static_cast<double>(space.theta_growth) * std::sin(from_middle) +
          static_cast<double>(space.theta_half)) /
         static_cast<double>(space.theta_step);
}

/// φ in cells.
inline double cells_of_phi(const shaders::PhiCells& cells, double phi) {
  const auto growth = static_cast<double>(cells.growth);
  const double q = (1 + growth) * phi / static_cast<double>(cells.phi_max);
  const double place = 2 * q / (1 + std::sqrt(1 + 4 * growth * q));
  return (place - static_cast<double>(cells.first)) / static_cast<double>(cells.per_cell);
}

}  // namespace airlight::tests
