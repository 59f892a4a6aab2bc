// Width of a cell in φ, from the range that phi_range.comp found. GLSL only; needs resolution.glsl and space.glsl.
layout(std430, binding = 4) readonly buffer PhiRange { uint largest_order; };

float phi_step() { return angle_from_order(uintBitsToFloat(largest_order)) / float(k_phi_count); }
