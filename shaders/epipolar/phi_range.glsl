// The cells in φ of this frame. GLSL only; needs resolution.glsl and grid.glsl.
layout(std430, binding = k_phi_range_storage) readonly buffer PhiRange {
  uint largest_order;  // angle_order of φ_max, from phi_range.comp
  float phi_growth;    // PhiCells.growth
};

PhiCells phi_cells() {
  return PhiCells(angle_from_order(uintBitsToFloat(largest_order)), phi_growth, float(k_phi_count));
}
