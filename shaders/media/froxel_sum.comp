#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/froxel_ray.glsl"

// Airlight from the eye to the end of each froxel, in place of what it scatters.
// Based on: Hillaire, "Physically Based and Unified Volumetric Rendering in Frostbite", SIGGRAPH 2015 course Advances in Real-Time
// Rendering, "Scattering integration": what a slice scatters is dimmed all along the slice, in closed form.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = k_froxels_image, rgba32f) uniform image3D froxels;

void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  ivec2 count = imageSize(froxels).xy;
  if (tile.x >= count.x || tile.y >= count.y) return;
  MediumRay ray = medium_ray(place_of_tile(tile, vec2(0.5)), 0.0);
  vec3 sum = vec3(0.0);
  vec3 path = vec3(0.0);  // optical depth of what lies before a slice
  float from = 0.0;
  for (uint i = 0u; i < froxel_counts.y; ++i) {
    float to = distance_of_slice(ray, float(i) + 1.0);
    vec4 froxel = imageLoad(froxels, ivec3(tile, i));
    float length = (to - from) * froxel.a;
    vec3 depth = medium.sigma_t * length;
    sum += length * froxel.rgb * exp(-min(path, vec3(k_deepest))) *
           vec3(mean_decay(depth.x), mean_decay(depth.y), mean_decay(depth.z));
    path += depth;
    imageStore(froxels, ivec3(tile, i), vec4(sum, 0.0));
    from = to;
  }
}
