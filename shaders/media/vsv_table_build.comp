#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/grid.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "media/medium.glsl"
#include "media/vsv_table.glsl"

// One invocation integrates one row outwards.
layout(local_size_x = 8) in;
layout(constant_id = 3) const uint k_phase = 0;
layout(std430, binding = k_table_storage) buffer Table { float table[]; };

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= k_table_rows) return;
  float complement = k_pi - (space.alpha_min + float(row) * medium.table_row_step);
  PhiCells cells = phi_cells();
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k <= k_phi_count; ++k) {
    for (uint channel = 0u; channel < k_channels; ++channel) {
      uint at = 2u * table_index(row, k, channel);
      table[at] = sum[channel];                                                          // this row
      if (row > 0u) table[at - 2u * table_index(1u, 0u, 0u) + 1u] = sum[channel];  // its upper neighbour's next row
    }
    float from = phi_of_cell(cells, float(k));
    float to = min(phi_of_cell(cells, float(k + 1u)), complement);
    if (to > from) sum += integrate_cell(space, medium, k_phase, complement, from, to);
  }
}
