// The table S(α, φ) = ∫₀^φ e^{−σ_t (t + r)} p(α + φ) dφ. Columns lie at the boundaries of the grid's cells in φ, rows at
// equal steps over the frame's range of α. An entry is a vec2: S in its row and in the next one, so that one load serves
// the interpolation in α. GLSL only; needs resolution.glsl.
layout(constant_id = 4) const uint k_channels = 1;  // 1 where σ_t is grey, else 3
layout(constant_id = 5) const uint k_table_rows = 256;

uint table_index(uint row, uint k, uint channel) { return (row * (k_phi_count + 1u) + k) * k_channels + channel; }

// Distance of the rows in α [rad].
float table_row_step(EpipolarBlock space) {
  return space.alpha_step * float(k_alpha_count) / (float(k_table_rows) - 1.0);
}
