// The voxel grid: which cell holds what, and where its bit is stored.
//
// N_α × N_θ × N_φ bits. Cells in α cover the frame's range; cells in θ cover the frame's range, or a turn, denser in its middle; cells
// in φ cover what of each half-plane can be in shadow and is seen, and grow along it. A cell is represented by its centre. One 128-bit texel
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

// Cells in α are equal, or equal in √α where the light is in view, in √(π − α) where what is opposite to it is: near the axis the
// rows of a plane are short, and light changes within an α of its own size.
CONST float k_equal_alpha = 0.0f;
CONST float k_root_of_alpha = 1.0f;
CONST float k_root_of_complement = 2.0f;

// α in what cells are equal in, from the start of the range.
FUNCTION float spaced_alpha(IN(EpipolarBlock) space, Angle alpha) {
  float a = float(alpha);
  float start = float(space.alpha_min);
  if (space.alpha_spacing == k_root_of_alpha) return sqrt(max(a, 0.0f)) - sqrt(max(start, 0.0f));
  if (space.alpha_spacing == k_root_of_complement) return sqrt(max(k_pi - start, 0.0f)) - sqrt(max(k_pi - a, 0.0f));
  return a - start;
}

// Rows from the start of the range to α; boundaries of cells lie at whole numbers.
FUNCTION Cell cell_of_alpha(IN(EpipolarBlock) space, Angle alpha) { return Cell(spaced_alpha(space, alpha) / space.alpha_step); }

// Its inverse; of a cell the same bits in every program.
FUNCTION Angle alpha_of_cell(IN(EpipolarBlock) space, Cell cell) {
  PRECISE float from_start = float(cell) * space.alpha_step;
  float start = float(space.alpha_min);
  PRECISE float alpha = start + from_start;
  if (space.alpha_spacing == k_root_of_alpha) {
    PRECISE float root = max(sqrt(max(start, 0.0f)) + from_start, 0.0f);
    alpha = root * root;
  }
  if (space.alpha_spacing == k_root_of_complement) {
    PRECISE float root = max(sqrt(max(k_pi - start, 0.0f)) - from_start, 0.0f);
    alpha = k_pi - root * root;
  }
  return Angle(alpha);
}

// The cell that holds α, the nearest one for an α outside the range.
FUNCTION uint alpha_cell(IN(EpipolarBlock) space, Angle alpha, uint alpha_count) {
  Cell i = floor(cell_of_alpha(space, alpha));
  return uint(clamp(i, Cell(0.0f), Cell(float(alpha_count) - 1.0f)));
}

// The first cell whose centre lies in the shadow of an occluder at α: the boundary nearest to it, so that the shadow is
// as often too long as too short. An occluder nearer the axis than the range shadows all of it. N_α if none.
FUNCTION uint first_shadowed_cell(IN(EpipolarBlock) space, Angle alpha, uint alpha_count) {
  float i = ceil(float(cell_of_alpha(space, alpha)) - 0.5f);
  return uint(clamp(i, 0.0f, float(alpha_count)));
}

// How φ is cut into the cells of a half-plane. At x ∈ [0, 1] lies φ = φ_max x (1 + c x) / (1 + c), alike in all half-planes; each
// cuts its own range of x into equal cells. Over the whole range the last cells are 1 + 2c times as wide as the first; c = 0 cuts
// equally, as the paper does.
struct PhiCells {
  Angle phi_max;
  float growth;    // c ≥ 0
  Cell count;      // N_φ
  float first;     // x where the first cell begins
  float per_cell;  // of x
};

FUNCTION Angle phi_of_place(IN(PhiCells) cells, float x) {
  return cells.phi_max * x * (1.0f + cells.growth * x) / (1.0f + cells.growth);
}

FUNCTION float place_of_phi(IN(PhiCells) cells, Angle phi) {
  float q = (1.0f + cells.growth) * (phi / cells.phi_max);
  return 2.0f * q / (1.0f + sqrt(1.0f + 4.0f * cells.growth * q));
}

// The cells of a half-plane that shares the range [0, φ_max] with all.
FUNCTION PhiCells shared_cells(Angle phi_max, float growth, Cell count) {
  PhiCells cells;
  cells.phi_max = phi_max;
  cells.growth = growth;
  cells.count = count;
  cells.first = 0.0f;
  cells.per_cell = 1.0f / float(count);
  return cells;
}

// Those of one whose range is [lower, upper] ⊂ [0, φ_max]; of none where that is empty, which a cell of next to no width stands for.
FUNCTION PhiCells own_cells(Angle phi_max, float growth, Cell count, Angle lower, Angle upper) {
  PhiCells cells = shared_cells(phi_max, growth, count);
  cells.first = clamp(place_of_phi(cells, lower), 0.0f, 1.0f);
  cells.per_cell = max(clamp(place_of_phi(cells, upper), 0.0f, 1.0f) - cells.first, 1e-6f) / float(count);
  return cells;
}

FUNCTION float place_of_cell(IN(PhiCells) cells, Cell cell) { return cells.first + float(cell) * cells.per_cell; }

// φ at `cell` cells from the first; boundaries lie at whole numbers, centres half-way.
FUNCTION Angle phi_of_cell(IN(PhiCells) cells, Cell cell) { return phi_of_place(cells, place_of_cell(cells, cell)); }

// Inverse of phi_of_cell; no number of cells is farther out than a hundred times the grid.
FUNCTION Cell cell_of_phi(IN(PhiCells) cells, Angle phi) {
  return Cell(clamp((place_of_phi(cells, phi) - cells.first) / cells.per_cell, -100.0f * float(cells.count), 100.0f * float(cells.count)));
}

// Index of a 32-bit word of the grid: 32 consecutive φ from 32·word.
FUNCTION uint grid_word(uint alpha, uint theta, uint word, uint alpha_count, uint words_per_ray) {
  return (theta * alpha_count + alpha) * words_per_ray + word;
}

#endif
