// The froxels: voxels of the view frustum, tiles of the image in slices of depth.
#ifndef AIRLIGHT_FROXELS_GLSL
#define AIRLIGHT_FROXELS_GLSL
#include "frame/camera.glsl"

// The last slice is four times as thick as the first: its logarithm.
CONST float k_slice_exponent = 1.3862944f;

// Where a slice begins, or a part of it lies, by depth along the view's direction; of `count` slices up to the depth `far` [m].
FUNCTION float depth_of_slice(float slice, float count, float far) {
  return far * (exp(k_slice_exponent * slice / count) - 1.0f) / (exp(k_slice_exponent) - 1.0f);
}

// Its inverse.
FUNCTION float slice_of_depth(float depth, float count, float far) {
  return count / k_slice_exponent * log(1.0f + depth / far * (exp(k_slice_exponent) - 1.0f));
}

// A uniform block (std140): the frame before, as a froxel's history asks for it, written by media/froxel.cpp.
struct FroxelHistoryBlock {
  CameraBlock camera;
  float far;          // the depth of its last slice's end [m]
  float weight;       // of what was found then, 0 to 1
  uint first_look_up; // of a froxel in this frame: a number of place_in_froxel
  uint unused;
};

// Where a point lies in an image and among `count` slices up to the depth `far` [m]: pixels and slice, −1 behind the eye. `point`: relative
// to the eye.
FUNCTION vec3 place_in_slices(IN(CameraBlock) camera, IN(vec3) point, float count, float far) {
  float depth = dot(point, camera.forward);
  float ahead = max(depth, 1e-30f);
  float x = 0.5f + 0.5f * dot(point, camera.right) / (ahead * camera.half_width);
  float y = 0.5f - 0.5f * dot(point, camera.up) / (ahead * camera.half_height);
  float slice = slice_of_depth(max(depth, 0.0f), count, far);
  return vec3(x * camera.image_width, y * camera.image_height, depth > 0.0f ? slice : -1.0f);
}

// Where a look-up lies within a froxel, each side from 0 to 1; the first in the middle. After Roberts, "The Unreasonable Effectiveness
// of Quasirandom Sequences", 2018.
FUNCTION vec3 place_in_froxel(uint sample_index) {
  vec3 place = vec3(0.5f) + float(sample_index) * vec3(0.8191725f, 0.6710436f, 0.5497005f);
  return place - floor(place);
}

#endif
