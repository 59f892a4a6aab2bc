// Where the steps of a march along a view ray lie.
#ifndef AIRLIGHT_MARCH_STEPS_GLSL
#define AIRLIGHT_MARCH_STEPS_GLSL
#include "shared.glsl"

// Steps by distance: equally long as far as the scene reaches, and beyond, where nothing is but its shadows, equally long in 1/t, which
// comes to an end where t does not. There lies an eighth of them.
struct MarchSteps {
  float from;        // [m]
  float near_to;     // where those equal in t end [m]
  float to;          // [m]; k_endless and the like for nowhere
  float near_count;  // how many they are, …
  float count;       // … and all
};

// `reach`: how far from the eye the scene reaches, above 0 [m].
FUNCTION MarchSteps march_steps(float from, float to, float reach, float count) {
  MarchSteps steps;
  steps.from = from;
  steps.to = to;
  steps.near_to = clamp(reach, from, max(from, to));
  steps.count = count;
  steps.near_count = count - max(floor(0.125f * count), 1.0f);
  if (steps.near_to >= to) steps.near_count = count;
  if (steps.near_to <= from) steps.near_count = 0.0f;
  return steps;
}

// The distance at which a step begins, or a part of it lies [m]; `step` from 0 to the number of them.
FUNCTION float place_of_step(IN(MarchSteps) steps, float step) {
  if (step <= steps.near_count) {
    float part = step / max(steps.near_count, 1.0f);
    return min(steps.from + (steps.near_to - steps.from) * part, steps.near_to);
  }
  float part = (step - steps.near_count) / (steps.count - steps.near_count);
  return min(1.0f / ((1.0f - part) / steps.near_to + part / steps.to), steps.to);
}

// A number in (0, 1) of a pixel of which each square of 4 × 4 pixels has all sixteen, neighbours far apart.
// Based on: Bayer, "An optimum method for two-level rendition of continuous-tone pictures", ICC 1973; as offsets of samples after
// Keller and Heidrich, "Interleaved Sampling", EGWR 2001.
FUNCTION float interleaved_offset(IN(ivec2) pixel) {
  int x = pixel.x & 3;
  int differ = x ^ (pixel.y & 3);
  // From the lowest bits of both, which count most, to the next ones: the bit of x ^ y, then that of x.
  int rank = 8 * (differ & 1) + 4 * (x & 1) + (differ & 2) + (x >> 1);
  return (float(rank) + 0.5f) / 16.0f;
}

#endif
