#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "media/medium.glsl"
#include "media/vsv_table.glsl"

// One invocation integrates one row inwards.
layout(local_size_x = 8) in;
layout(constant_id = 3) const uint k_phase = 0;
layout(std430, binding = k_table_storage) buffer Table { float table[]; };

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= k_table_rows) return;
  float complement = row_complement(space, row);
  float upper_complement = row_complement(space, max(row, 1u) - 1u);
  PhiCells cells = shared_cells(largest_phi(), phi_growth, float(k_phi_count));
  float to = min(complement, cells.phi_max);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i <= k_phi_count + 1u; ++i) {
    uint k = k_phi_count + 1u - i;
    float from = phi_of_cell(cells, float(k));
    vec3 entry = vec3(0.0);
    if (k > k_phi_count) {
      // In pieces no longer than some cells: it may be nearly all that there is.
      const float k_pieces = 32.0;
      for (float piece = 0.0; piece < k_pieces; ++piece) {
        vec2 ends = mix(vec2(to), vec2(complement), vec2(piece, piece + 1.0) / k_pieces);
        entry += integrate_run(space, medium, k_phase, complement, ends.x, ends.y);
      }
    } else if (from < to) {
      bool is_smooth = to - from < 0.1 * (complement - from);
      if (k_rough != 0u) is_smooth = false;
      sum += is_smooth ? integrate_cell(space, medium, k_phase, complement, from, to)
                       : integrate_run(space, medium, k_phase, complement, from, to);
      to = from;
      entry = sum;
    } else if (phi_of_cell(cells, float(k) - 1.0) < upper_complement) {
      entry = -integrate_run(space, medium, k_phase, complement, max(2.0 * complement - from, 0.0), complement);
    }
    for (uint channel = 0u; channel < k_channels; ++channel) {
      // Of this row and its upper neighbour's next one; of this column and its left neighbour's next one.
      uint at = 4u * table_index(row, k, channel);
      uint above = 4u * table_index(1u, 0u, 0u);
      uint left = 4u * k_channels;
      table[at] = entry[channel];
      if (row > 0u) table[at - above + 1u] = entry[channel];
      if (k > 0u) table[at - left + 2u] = entry[channel];
      if (row > 0u && k > 0u) table[at - above - left + 3u] = entry[channel];
    }
  }
}
