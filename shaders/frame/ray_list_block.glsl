// What is known of a list of view rays, and of the epipolar samples that it serves (frame/epipolar_samples.h).
#ifndef AIRLIGHT_RAY_LIST_BLOCK_GLSL
#define AIRLIGHT_RAY_LIST_BLOCK_GLSL
#include "bindings.glsl"

// A uniform block (std140), and a storage block while rays are listed.
struct RayListBlock {
  uint count;    // of rays
  uint width;    // of the textures that hold one a texel: a multiple of 4
  uint height;
  uint slices;
  uint samples;  // of each slice: a multiple of 16
  uint step;     // every so many of them are marked, whatever they see: 16, 8, 4, 2 or 1
  uint unused[2];
};

// Samples and pixels are listed in groups of 16: the samples of a slice that follow one another, and squares of 4 × 4 pixels. A group has
// the number of its first ray in the list, and a bit for each of its members that has one.
struct RayGroup {
  uint first;
  uint listed;
};

#endif
