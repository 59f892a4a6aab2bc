// The voxel grid: which cell holds what, and where its bit is stored.
//
// N_α × N_θ × N_φ bits. Cells in θ and α are equal and cover the frame's ranges of θ and α; cells in φ cover [0, φ_max] and grow along it. A cell is represented by its centre. One 128-bit texel (uvec4) holds 128 consecutive φ at one (α, θ),
// lowest bit first; the N_φ / 128 texels of a view ray are neighbours in memory, then the rays of one plane in order of α.
#ifndef AIRLIGHT_GRID_GLSL
#define AIRLIGHT_GRID_GLSL
#include "epipolar/space.glsl"

// Centre of plane j; may lie beyond ±π.
FUNCTION float theta_centre(IN(EpipolarBlock) space, uint j) {
  return space.theta_middle + ((float(j) + 0.5f) * space.theta_step - space.theta_half);
}

// What to add to θ ∈ [−π, π] so that it lies within π of the middle of the range.
FUNCTION float theta_turn(IN(EpipolarBlock) space, float theta) {
  float from_middle = theta - space.theta_middle;
  return from_middle > k_pi ? -2.0f * k_pi : from_middle < -k_pi ? 2.0f * k_pi : 0.0f;
}

// The plane whose cell holds θ ∈ [−π, π], the nearest one for a θ outside the range.
FUNCTION uint theta_cell(IN(EpipolarBlock) space, float theta, uint theta_count) {
  float from_start = theta + theta_turn(space, theta) - space.theta_middle + space.theta_half;
  return uint(clamp(floor(from_start / space.theta_step), 0.0f, float(theta_count) - 1.0f));
}

// The cell that holds α, the nearest one for an α outside the range.
FUNCTION uint alpha_cell(IN(EpipolarBlock) space, float alpha, uint alpha_count) {
  float i = floor((alpha - space.alpha_min) / space.alpha_step);
  return uint(clamp(i, 0.0f, float(alpha_count) - 1.0f));
}

// The first cell whose centre lies in the shadow of an occluder at α: the boundary nearest to it, so that the shadow is
// as often too long as too short. An occluder nearer the axis than the range shadows all of it. N_α if none.
FUNCTION uint first_shadowed_cell(IN(EpipolarBlock) space, float alpha, uint alpha_count) {
  float i = ceil((alpha - space.alpha_min) / space.alpha_step - 0.5f);
  return uint(clamp(i, 0.0f, float(alpha_count)));
}

// How [0, φ_max] is cut into cells: at x ∈ [0, 1] of the way through the cells lies φ = φ_max x (1 + c x) / (1 + c). The last
// cells are 1 + 2c times as wide as the first; c = 0 cuts equally, as the paper does.
struct PhiCells {
  float phi_max;  // [rad]
  float growth;   // c ≥ 0
  float count;    // N_φ
};

// φ at `cell` cells from 0; boundaries lie at whole numbers, centres half-way.
FUNCTION float phi_of_cell(IN(PhiCells) cells, float cell) {
  float x = cell / cells.count;
  return cells.phi_max * x * (1.0f + cells.growth * x) / (1.0f + cells.growth);
}

// Inverse of phi_of_cell.
FUNCTION float cell_of_phi(IN(PhiCells) cells, float phi) {
  float q = (1.0f + cells.growth) * phi / cells.phi_max;
  return cells.count * 2.0f * q / (1.0f + sqrt(1.0f + 4.0f * cells.growth * q));
}

// Index of a 32-bit word of the grid: 32 consecutive φ from 32·word.
FUNCTION uint grid_word(uint alpha, uint theta, uint word, uint alpha_count, uint words_per_ray) {
  return (theta * alpha_count + alpha) * words_per_ray + word;
}

#endif
