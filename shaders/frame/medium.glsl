// The homogeneous medium, as the shaders see it.
#ifndef AIRLIGHT_MEDIUM_BLOCK_GLSL
#define AIRLIGHT_MEDIUM_BLOCK_GLSL
#include "shared.glsl"

// A uniform block (std140), written once a frame by frame/blocks.cpp.
struct MediumBlock {
  vec3 sigma_s;           // scattering coefficient [1/m]
  float g;                // mean cosine of Henyey-Greenstein, alone or as a part of Hoffman-Preetham
  vec3 sigma_t;           // extinction coefficient [1/m]
  float rayleigh_weight;  // of Hoffman-Preetham: the part that Rayleigh's function has, 0 to 1
};

#endif
