#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/froxel_ray.glsl"
#include "frame/shadow_of_air.glsl"

// What a froxel scatters towards the eye, by its length in the medium, flattened, and how much of it lies in the medium.
// Based on: Wronski, "Volumetric Fog: Unified, Compute Shader Based Solution to Atmospheric Scattering", SIGGRAPH 2014 course Advances
// in Real-Time Rendering, "density estimation and volume lighting". Deviation: a lamp's light is the integral over a ray's part in
// the slice, over φ, in which 1/r² has gone, not its value at a point, which near the lamp may be any.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = k_froxels_image, rgba32f) writeonly uniform image3D froxels;

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
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < froxel_counts.z; ++i) {
    vec3 place = place_in_froxel(i);
    MediumRay ray = medium_ray(place_of_tile(froxel.xy, place.xy), 0.0);
    float start = distance_of_slice(ray, float(froxel.z));
    float end = distance_of_slice(ray, float(froxel.z) + 1.0);
    float from = max(start, ray.entry);
    float to = min(end, ray.distance);
    float inside = max(to - from, 0.0) / (end - start);
    if (inside > 0.0) {
      vec3 scattered = vec3(0.0);
      if (is_lit(mix(from, to, place.z) * ray.direction))
        scattered = flattening(ray) * (k_sun != 0u ? scattered_by_sun(ray, from, to) : scattered_by_lamp(ray, from, to));
      sum += inside * vec4(scattered, 1.0);
    }
  }
  imageStore(froxels, froxel, vec4(sum.rgb / max(sum.a, 1e-30), sum.a / float(froxel_counts.z)));
}
