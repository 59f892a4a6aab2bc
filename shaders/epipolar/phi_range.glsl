// The cells in φ of this frame. GLSL only; after uniforms.glsl. Who writes the range defines PHI_RANGE_ACCESS, empty.
#include "epipolar/resolution.glsl"
#ifndef PHI_RANGE_ACCESS
#define PHI_RANGE_ACCESS readonly
#endif

layout(std430, binding = k_phi_range_storage) PHI_RANGE_ACCESS buffer PhiRange {
  uint largest_order;  // angle_order of φ_max, from phi_range.comp; floats ≥ 0 sort like their bits
  float phi_growth;    // PhiCells.growth
};

// A camera that sees nothing but a surface at the eye itself has no range.
float largest_phi() { return max(angle_from_order(uintBitsToFloat(largest_order)), 1e-6); }

PhiCells phi_cells() { return PhiCells(largest_phi(), phi_growth, float(k_phi_count)); }
