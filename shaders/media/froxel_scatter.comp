#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/froxel_ray.glsl"
#include "frame/shadow_of_air.glsl"

// What a froxel scatters towards the eye, by its length in the medium, flattened, and how much of it lies in the medium.
// Based on: Wronski, "Volumetric Fog: Unified, Compute Shader Based Solution to Atmospheric Scattering", SIGGRAPH 2014 course Advances
// in Real-Time Rendering, "density estimation and volume lighting". Deviation: a lamp's light is the integral over a ray's part in
// the slice, over φ, in which 1/r² has gone, not its value at a point, which near the lamp may be any.
//
// With a history, what part of a froxel is lit is for the most part what the frame before found there, and its own look-ups lie elsewhere in
// each frame (the same course notes, "temporal reprojection"). Deviation: not the scattered light is kept from frame to frame but what of
// it is lit: all else is computed without look-ups, in each frame as it is then.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = k_froxels_image, rgba32f) writeonly uniform image3D froxels;
layout(constant_id = 22) const uint k_history = 0;
layout(std140, binding = k_froxel_history_block) uniform FroxelHistoryUniform { FroxelHistoryBlock before; };
layout(binding = k_lit_image, r32f) writeonly uniform image3D lit_image;
layout(binding = k_scratch_unit) uniform sampler3D lit_before;

// The part of a ray within a slice, or of that which lies in the medium, and how much of the slice that is.
struct Stretch {
  float from;
  float to;
  float inside;
};

Stretch stretch_of(MediumRay ray, int slice) {
  float start = distance_of_slice(ray, float(slice));
  float end = distance_of_slice(ray, float(slice) + 1.0);
  float from = max(start, ray.entry);
  float to = min(end, ray.distance);
  float inside = max(to - from, 0.0) / (end - start);
  return Stretch(inside > 0.0 ? from : start, inside > 0.0 ? to : end, inside);
}

// 1 where the light reaches a place in a froxel, 0 where not.
float lit_at(ivec3 froxel, vec3 place) {
  MediumRay ray = medium_ray(place_of_tile(froxel.xy, place.xy), 0.0);
  Stretch stretch = stretch_of(ray, froxel.z);
  return is_lit(mix(stretch.from, stretch.to, place.z) * ray.direction) ? 1.0 : 0.0;
}

// What part of a froxel was lit in the frame before, and with what weight: 0 where that did not see the froxel's middle.
vec2 found_before(ivec3 froxel, vec3 count) {
  vec3 direction = view_ray(camera, place_of_tile(froxel.xy, vec2(0.5)));
  float depth = depth_of_slice(float(froxel.z) + 0.5, count.z, uintBitsToFloat(froxel_counts.x));
  vec3 moved = (camera.eye_high - before.camera.eye_high) + (camera.eye_low - before.camera.eye_low);
  vec3 place = place_in_slices(before.camera, direction * (depth / dot(direction, camera.forward)) + moved, count.z, before.far);
  vec3 most = vec3(before.camera.image_width, before.camera.image_height, count.z);
  vec3 nearest = clamp(place, vec3(0.0), most);
  float lit = textureLod(lit_before, nearest / (vec3(k_tile, k_tile, 1.0) * count), 0.0).r;
  return vec2(lit, nearest == place ? before.weight : 0.0);
}

// From `from` to `to` along the ray, all of it lit, by its length [1/m …]; not dimmed between there and the eye.
vec3 scattered_by_lamp(MediumRay ray, float from, float to) {
  LayerRay view = in_plane(ray);
  LitPart part = part_in_reach(space, light, k_reach, view, phi_at(space, ray.angle, from), phi_at(space, ray.angle, to));
  vec3 sum = vec3(0.0);
  float count = parts_of(part.to - part.from);
  float width = (part.to - part.from) / max(count, 1.0);
  for (float i = 0.0; i < count; ++i) {
    float phi = part.from + (i + 0.5) * width;
    float path = light_path(medium, light, layer_distance(space, view, phi) * ray.direction);
    sum += integrand_of_path(medium, k_phase, path, view.complement, phi) * colour_at(view, phi);
  }
  return airlight_scale(space, light, medium, ray.angle.sine) * sum * (width / (to - from));
}

vec3 scattered_by_sun(MediumRay ray, float from, float to) {
  vec3 depth = medium.sigma_t * light_path(medium, light, 0.5 * (from + to) * ray.direction);
  return sun_scale(light, medium, k_phase, ray.alpha) * exp(-min(depth, vec3(k_deepest)));
}

void main() {
  ivec3 froxel = ivec3(gl_GlobalInvocationID);
  ivec3 count = imageSize(froxels);
  if (froxel.x >= count.x || froxel.y >= count.y) return;
  vec2 found = vec2(0.0);
  if (k_history != 0u) {
    if (before.weight > 0.0) found = found_before(froxel, vec3(count));
  }
  vec4 sum = vec4(0.0);
  float lit_sum = 0.0;
  for (uint i = 0u; i < froxel_counts.z; ++i) {
    vec3 place = place_in_froxel(i);
    MediumRay ray = medium_ray(place_of_tile(froxel.xy, place.xy), 0.0);
    Stretch stretch = stretch_of(ray, froxel.z);
    float lit = 0.0;
    if (k_history != 0u) {
      lit = mix(lit_at(froxel, place_in_froxel(before.first_look_up + i)), found.x, found.y);
    } else if (stretch.inside > 0.0) {
      lit = is_lit(mix(stretch.from, stretch.to, place.z) * ray.direction) ? 1.0 : 0.0;
    }
    lit_sum += lit;
    if (stretch.inside > 0.0) {
      vec3 scattered = vec3(0.0);
      if (lit > 0.0) {
        scattered = flattening(ray) * (k_sun != 0u ? scattered_by_sun(ray, stretch.from, stretch.to)
                                                   : scattered_by_lamp(ray, stretch.from, stretch.to));
      }
      sum += stretch.inside * vec4(lit * scattered, 1.0);
    }
  }
  imageStore(froxels, froxel, vec4(sum.rgb / max(sum.a, 1e-30), sum.a / float(froxel_counts.z)));
  if (k_history != 0u) imageStore(lit_image, froxel, vec4(lit_sum / float(froxel_counts.z)));
}
