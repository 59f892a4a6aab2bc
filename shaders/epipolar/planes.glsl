// The half-planes of this frame, from planes.comp, plane_range.comp and plane_cells.comp: look-ups instead of inversions of how they
// are spaced and cut. GLSL only.
#ifndef AIRLIGHT_PLANES_GLSL
#define AIRLIGHT_PLANES_GLSL
layout(binding = k_planes_unit) uniform samplerBuffer planes;  // two texels a plane

// Cosine and sine of the centre's θ.
vec2 plane_direction(uint plane) { return texelFetch(planes, 2 * int(plane)).xy; }

// θ from the middle, at both borders.
vec2 plane_borders(uint plane) { return texelFetch(planes, 2 * int(plane)).zw; }

// The range of φ in which something may cast a shadow on what is seen.
vec2 plane_phi(uint plane) { return texelFetch(planes, 2 * int(plane) + 1).xy; }

// Where its first cell in φ begins, and how wide its cells are: PhiCells.first and .per_cell.
vec2 plane_places(uint plane) { return texelFetch(planes, 2 * int(plane) + 1).zw; }
#endif
