#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/epipolar_lines.glsl"
#include "frame/uniforms.glsl"
#include "frame/list_rays.glsl"

// Lists the marked samples of each slice: those at equal steps, closer next to an epipole in the image; those on both sides of where depth
// breaks, so that between marked ones it does not; and more where airlight without shadows bends. 16 samples an invocation.
// Based on: Engelhardt and Dachsbacher 2010, section 3.2. Deviation: depth breaks where it leaves the plane that two samples lie on, so
// that slanted surfaces do not.
layout(local_size_x = 64) in;
layout(binding = k_sample_depths_unit) uniform sampler2D samples_seen;  // sample_depths.frag

// Of the nearest of three samples in line, by how much the middle one is beside the mean of the others.
const float k_break = 0.005;
// Of the largest of three samples' airlight: the same.
const float k_bend = 0.003;

vec2 seen_at(uint sample_number, uint slice) {
  return texelFetch(samples_seen, ivec2(min(sample_number, uint(textureSize(samples_seen, 0).x) - 1u), slice), 0).rg;
}

bool is_beside_mean(float before, float here, float after, float part) {
  return abs(0.5 * (before + after) - here) > part * max(here, max(before, after));
}

void main() {
  uint samples = rays.samples;
  uint groups_in_slice = samples >> 4;
  uint group = gl_GlobalInvocationID.x;
  if (group >= rays.slices * groups_in_slice) return;
  uint slice = group / groups_in_slice;
  uint first = 16u * (group % groups_in_slice);
  bool is_inside = epipolar_lines(camera, light.axis).is_inside;

  uint listed = 0xffffu / ((1u << rays.step) - 1u);  // every so many bits
  if (first == 0u && is_inside) listed |= 0x0117u;
  if (first + 16u == samples) listed |= 0x8000u;
  uint breaks = 0u;
  float airlight[17];
  float before = seen_at(first - min(first, 1u), slice).x;
  vec2 here = seen_at(first, slice);
  for (uint i = 0u; i < 16u; ++i) {
    vec2 after = seen_at(first + i + 1u, slice);
    if (is_beside_mean(before, here.x, after.x, k_break)) breaks |= 1u << i;
    airlight[i] = here.y;
    before = here.x;
    here = after;
  }
  airlight[16] = here.y;
  listed |= breaks;
  for (uint length = 16u; length > 1u; length >>= 1) {
    for (uint i = 0u; i < 16u; i += length) {
      bool is_broken = (breaks >> i & ((2u << length) - 1u)) != 0u;
      uint middle = i + (length >> 1);
      if (!is_broken && is_beside_mean(airlight[i], airlight[middle], airlight[i + length], k_bend)) listed |= 1u << middle;
    }
  }

  uint ray = take_rays(uint(bitCount(listed)));
  groups[group] = RayGroup(ray, listed);
  while (listed != 0u) {
    members[ray] = slice * samples + first + uint(findLSB(listed));
    listed &= listed - 1u;
    ++ray;
  }
}
