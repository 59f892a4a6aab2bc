// The voxel grid: which cell holds what, and where its bit is stored.
//
// N_α × N_θ × N_φ bits. Cells in α are equal and cover the frame's range; cells in θ cover the frame's range, or a turn,
// denser in its middle; cells in φ cover [0, φ_max] and grow along it. A cell is represented by its centre. One 128-bit texel
// (uvec4) holds 128 consecutive φ at one (α, θ), lowest bit first; the N_φ / 128 texels of a view ray are neighbours in
// memory, then the rays of one plane in order of α.
#ifndef AIRLIGHT_GRID_GLSL
#define AIRLIGHT_GRID_GLSL
#include "epipolar/space.glsl"

// Planes from the start of the range to an angle from its middle, in [−π, π]. Cells are denser towards the middle, where
// with the epipole off the image's centre the rays of a plane reach farthest.
FUNCTION Cell plane_of_theta(IN(EpipolarBlock) space, Angle from_middle) {
  return Cell((from_middle + Angle(space.theta_growth * sine(from_middle)) + space.theta_half) / space.theta_step);
}

// Inverse of plane_of_theta, by Newton's method on a function that is concave on one side and convex on the other.
FUNCTION Angle theta_of_plane(IN(EpipolarBlock) space, Cell plane) {
  Angle y = float(plane) * space.theta_step - space.theta_half;
  Angle x = y;
  for (int i = 0; i < 7; ++i) {
    x -= (x + Angle(space.theta_growth * sine(x)) - y) / (1.0f + space.theta_growth * cosine(x));
  }
  return x;
}

// θ of the centre of plane j; may lie beyond ±π.
FUNCTION Angle theta_centre(IN(EpipolarBlock) space, uint j) {
  return space.theta_middle + theta_of_plane(space, Cell(float(j) + 0.5f));
}

// θ ∈ [−π, π] from the middle of the range, in [−π, π].
FUNCTION Angle theta_from_middle(IN(EpipolarBlock) space, Angle theta) {
  Angle x = theta - space.theta_middle;
  return x > k_half_turn ? x - 2.0f * k_half_turn : x < -k_half_turn ? x + 2.0f * k_half_turn : x;
}

// The plane whose cell holds θ ∈ [−π, π], the nearest one for a θ outside the range.
FUNCTION uint theta_cell(IN(EpipolarBlock) space, Angle theta, uint theta_count) {
  Cell plane = plane_of_theta(space, theta_from_middle(space, theta));
  return uint(clamp(floor(plane), Cell(0.0f), Cell(float(theta_count) - 1.0f)));
}

// From θ to the centre of the plane whose cell holds it, to first order in the cell's width.
FUNCTION Angle theta_to_centre(IN(EpipolarBlock) space, Angle theta, uint j) {
  Angle x = theta_from_middle(space, theta);
  Cell planes = Cell(float(j) + 0.5f) - plane_of_theta(space, x);
  return float(planes) * space.theta_step / (1.0f + space.theta_growth * cosine(x));
}

// The cell that holds α, the nearest one for an α outside the range.
FUNCTION uint alpha_cell(IN(EpipolarBlock) space, Angle alpha, uint alpha_count) {
  float i = floor((alpha - space.alpha_min) / space.alpha_step);
  return uint(clamp(i, 0.0f, float(alpha_count) - 1.0f));
}

// The first cell whose centre lies in the shadow of an occluder at α: the boundary nearest to it, so that the shadow is
// as often too long as too short. An occluder nearer the axis than the range shadows all of it. N_α if none.
FUNCTION uint first_shadowed_cell(IN(EpipolarBlock) space, Angle alpha, uint alpha_count) {
  float i = ceil((alpha - space.alpha_min) / space.alpha_step - 0.5f);
  return uint(clamp(i, 0.0f, float(alpha_count)));
}

// How [0, φ_max] is cut into cells: at x ∈ [0, 1] of the way through the cells lies φ = φ_max x (1 + c x) / (1 + c). The last
// cells are 1 + 2c times as wide as the first; c = 0 cuts equally, as the paper does.
struct PhiCells {
  Angle phi_max;
  float growth;  // c ≥ 0
  Cell count;    // N_φ
};

// φ at `cell` cells from 0; boundaries lie at whole numbers, centres half-way.
FUNCTION Angle phi_of_cell(IN(PhiCells) cells, Cell cell) {
  float x = cell / cells.count;
  return cells.phi_max * x * (1.0f + cells.growth * x) / (1.0f + cells.growth);
}

// Inverse of phi_of_cell.
FUNCTION Cell cell_of_phi(IN(PhiCells) cells, Angle phi) {
  float q = (1.0f + cells.growth) * phi / cells.phi_max;
  return cells.count * 2.0f * q / (1.0f + sqrt(1.0f + 4.0f * cells.growth * q));
}

// Index of a 32-bit word of the grid: 32 consecutive φ from 32·word.
FUNCTION uint grid_word(uint alpha, uint theta, uint word, uint alpha_count, uint words_per_ray) {
  return (theta * alpha_count + alpha) * words_per_ray + word;
}

#endif
