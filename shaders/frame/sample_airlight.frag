#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/epipolar_lines.glsl"
#include "frame/ray_list.glsl"
#include "frame/uniforms.glsl"

// Airlight of each epipolar sample, without its peak: its own, or between those of the marked ones on both sides of it; and 1/depth, so
// that who asks for the one has the other. A row a slice.
layout(binding = k_ray_groups_unit) uniform usamplerBuffer groups;
layout(binding = k_airlight_unit) uniform sampler2D ray_airlight;
layout(binding = k_sample_depths_unit) uniform sampler2D sample_depths;
layout(location = 0) out vec4 flat_airlight;

vec3 airlight_of(EpipolarLine line, uint ray_number, float sample_number) {
  vec2 place = sample_place(line, sample_number, rays.samples);
  vec3 airlight = texelFetch(ray_airlight, texel_of_ray(ray_number), 0).rgb;
  return airlight / airlight_peak(camera, light.axis, light.is_near, place);
}

void main() {
  uvec2 texel = uvec2(gl_FragCoord.xy);
  EpipolarLine line = slice_line(epipolar_lines(camera, light.axis), texel.y, rays.slices);
  int group = int((texel.y * rays.samples + texel.x) >> 4);
  RayGroup here = RayGroup(texelFetch(groups, 2 * group).r, texelFetch(groups, 2 * group + 1).r);
  uint bit = texel.x & 15u;
  // The first sample of a group is marked, and so is the last of a slice.
  uint up_to = here.listed & ((2u << bit) - 1u);
  uint left = uint(findMSB(up_to));
  uint left_ray = here.first + uint(bitCount(up_to)) - 1u;
  vec3 airlight = airlight_of(line, left_ray, float(texel.x - bit + left));
  if (left < bit) {
    uint after = here.listed & ~((2u << bit) - 1u);
    uint right = after != 0u ? uint(findLSB(after)) : 16u;
    uint right_ray = after != 0u ? left_ray + 1u : texelFetch(groups, 2 * group + 2).r;
    vec3 other = airlight_of(line, right_ray, float(texel.x - bit + right));
    airlight = mix(airlight, other, float(bit - left) / float(right - left));
  }
  flat_airlight = vec4(airlight, texelFetch(sample_depths, ivec2(texel), 0).r);
}
