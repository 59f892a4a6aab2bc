#version 450
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"

// The mean of the sixteen pixels about a pixel that together have all offsets of look-ups, but for those on surfaces nearer or farther
// away: what interleaved look-ups leave as a pattern goes, and shafts are softened by as many pixels.
// Based on: Tóth and Umenhoffer, "Real-time Volumetric Lighting in Participating Media", Eurographics 2009 short papers, section 3.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_scratch_unit) uniform sampler2D scattered;
layout(location = 0) out vec4 airlight;

// Of the nearer one's distance, by which surfaces may be apart to count as one.
const float k_apart = 0.05;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(surface_image, 0) - 1;
  float distance = texelFetch(surface_image, pixel, 0).w;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 16; ++i) {
    ivec2 other = pixel + ivec2(i & 3, i >> 2) - 1;
    ivec2 inside = clamp(other, ivec2(0), last);
    float its = texelFetch(surface_image, inside, 0).w;
    bool is_like = other == inside && abs(its - distance) <= k_apart * min(its, distance);
    if (is_like) sum += vec4(texelFetch(scattered, inside, 0).rgb, 1.0);
  }
  airlight = vec4(sum.rgb / (sum.w * texelFetch(scattered, pixel, 0).a), 1.0);  // flattened by march.frag
}
