// The table T(α, φ) = ∫_φ^{φ_max} e^{−σ_t (t + r)} p(α + φ) dφ, what light comes from between φ and the end of the frame's cells, and
// a last column for what comes from beyond. Counted from that end, the dim light from behind a dark stretch is no difference of
// two large numbers, nor is what a far light gives before a surface, next to all that it gives. Where rays end before, at
// φ = π − α, T counts from there and goes on as an odd function: an interpolation between two rows, or two columns, of which one
// lies beyond meets no kink.
//
// Columns lie at the boundaries of the cells in φ of a half-plane that shares its range with all, rows equally far apart in
// table_place over the frame's range of α. An entry is a vec4: T in its row and in the next one, here and in the next column, so that one load serves the interpolation in α
// and, for the half-planes' own cells, in φ. GLSL only; needs resolution.glsl.
#include "media/table_place.glsl"
layout(constant_id = 4) const uint k_channels = 1;  // 1 where σ_t is grey, else 3
layout(constant_id = 5) const uint k_table_rows = 256;

// Whether the integrand may change much within a cell.
layout(constant_id = 9) const uint k_rough = 0;

uint table_index(uint row, uint k, uint channel) { return (row * (k_phi_count + 2u) + k) * k_channels + channel; }

// The places of the first and the last row.
vec2 table_range(EpipolarBlock space) {
  return vec2(table_place(space.alpha_min), table_place(alpha_of_cell(space, float(k_alpha_count))));
}

// π − α of a row.
float row_complement(EpipolarBlock space, uint row) {
  vec2 range = table_range(space);
  return complement_at(mix(range.x, range.y, float(row) / (float(k_table_rows) - 1.0)));
}
