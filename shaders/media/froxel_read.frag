#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/froxel_ray.glsl"
#include "frame/shadow_of_air.glsl"

// Each pixel's airlight from the froxels, interpolated between them, up to its surface. Beyond the last slice, where nothing is but
// shadows and the fog of what has no end, all is as lit as at its end.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_scratch_unit) uniform sampler3D froxels;
layout(location = 0) out vec4 airlight;

vec3 light_beyond(MediumRay ray, float from) {
  if (k_sun != 0u) {
    SunRay sun = sun_ray(medium, light, ray.direction, ray.distance);
    from = clamp(from, sun.entry, sun.exit);
    return sun_scale(light, medium, k_phase, ray.alpha) * integrate_sun_run(medium, sun, from, sun.exit);
  }
  LayerRay view = in_plane(ray);
  float start = max(phi_at(space, ray.angle, from), ray.phi_start);
  LitPart part = part_in_reach(space, light, k_reach, view, start, ray.phi_end);
  return airlight_scale(space, light, medium, ray.angle.sine) * integrate_parts(view, part.from, part.to);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 place = vec2(pixel) + 0.5;
  MediumRay ray = medium_ray(place, texelFetch(surface_image, pixel, 0).w);
  float last = distance_of_slice(ray, float(froxel_counts.y));
  float depth = min(ray.distance, last) * dot(ray.direction, camera.forward);
  // What is kept is airlight at the ends of slices; at the eye it is 0.
  float slices = clamp(slice_of_depth(depth, float(froxel_counts.y), uintBitsToFloat(froxel_counts.x)), 0.0, float(froxel_counts.y));
  vec3 size = vec3(textureSize(froxels, 0));
  vec3 at = vec3(place / (float(k_tile) * size.xy), (max(slices, 1.0) - 0.5) / size.z);
  vec3 radiance = textureLod(froxels, at, 0.0).rgb * (min(slices, 1.0) / flattening(ray));
  if (ray.distance > last && is_lit(last * ray.direction)) radiance += light_beyond(ray, last);
  airlight = vec4(radiance, 1.0);
}
