// The cells in φ of this frame. GLSL only; after uniforms.glsl. Who writes the ranges defines PHI_RANGE_ACCESS, empty.
#include "epipolar/resolution.glsl"
#include "epipolar/planes.glsl"
#ifndef PHI_RANGE_ACCESS
#define PHI_RANGE_ACCESS readonly
#endif

layout(std430, binding = k_phi_range_storage) PHI_RANGE_ACCESS buffer PhiRange {
  uint phi_max;      // the largest φ of all half-planes' ranges; floats ≥ 0 sort like their bits
  float phi_growth;  // PhiCells.growth
  uint seen[];       // of each half-plane the order of the largest φ where a view ray of the frame ends in it
};

// A camera that sees nothing but a surface at the eye itself has no range. That of a lamp 1e9 scene sizes away is no smaller.
float largest_phi() { return max(uintBitsToFloat(phi_max), is_sun(space) ? 1e-6 : 1e-12); }

// Of a half-plane, from plane_cells.comp.
PhiCells phi_cells(uint plane) {
  vec2 of_plane = plane_places(plane);
  return PhiCells(largest_phi(), phi_growth, float(k_phi_count), of_plane.x, of_plane.y);
}
