// What the passes over froxels share. GLSL only.
#include "media/lamp.glsl"
#include "media/froxels.glsl"
#include "media/sun.glsl"

layout(constant_id = 18) const uint k_sun = 0;
layout(constant_id = 21) const uint k_tile = 8;     // side of a tile [pixels]
// The depth of the last slice's end, a float's bits [m]; the numbers of slices, and of look-ups a froxel.
layout(location = 0) uniform uvec3 froxel_counts;

// The place of the image at a part of a tile, in pixels; of a tile over the image's side, inside of it.
vec2 place_of_tile(ivec2 tile, vec2 part) {
  return min((vec2(tile) + part) * float(k_tile), vec2(camera.image_width, camera.image_height));
}

// How far along a ray a slice begins, or a part of it lies [m].
float distance_of_slice(MediumRay ray, float slice) {
  return depth_of_slice(slice, float(froxel_counts.y), uintBitsToFloat(froxel_counts.x)) / dot(ray.direction, camera.forward);
}

// Airlight is kept times this: times sin α, by a lamp, it is smooth where the lamp is seen.
float flattening(MediumRay ray) {
  if (k_sun != 0u) return 1.0;
  return ray.angle.sine;
}
