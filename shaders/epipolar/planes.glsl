// The half-planes of this frame, from planes.comp: one look-up instead of an inversion of their spacing. GLSL only.
layout(binding = k_planes_unit) uniform samplerBuffer planes;  // cosine and sine of the centre's θ; θ from the middle at both borders
