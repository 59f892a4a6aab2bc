// The cells in φ of this frame. GLSL only; needs resolution.glsl and grid.glsl.
layout(std430, binding = k_phi_range_storage) readonly buffer PhiRange {
  uint largest_order;  // angle_order of φ_max, from phi_range.comp
  float phi_growth;    // PhiCells.growth
};

PhiCells phi_cells() {
  // A camera that sees nothing but a surface at the eye itself has no range.
  float phi_max = max(angle_from_order(uintBitsToFloat(largest_order)), 1e-6);
  return PhiCells(phi_max, phi_growth, float(k_phi_count));
}
