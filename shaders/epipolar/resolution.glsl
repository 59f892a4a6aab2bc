// The grid's resolution, fixed when a program is loaded. GLSL only.
#ifndef AIRLIGHT_RESOLUTION_GLSL
#define AIRLIGHT_RESOLUTION_GLSL
layout(constant_id = 0) const uint k_alpha_count = 256;
layout(constant_id = 1) const uint k_theta_count = 2048;
layout(constant_id = 2) const uint k_phi_count = 512;
const uint k_words_per_ray = k_phi_count / 32u;
const uint k_texels_per_ray = k_phi_count / 128u;
#endif
