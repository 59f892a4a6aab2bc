#version 450
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "frame/coarse_image.glsl"

// A pixel's airlight from that of the coarse image around it, by how near their rays are and how alike in depth their surfaces.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_scratch_unit) uniform sampler2D coarse_surface_image;
layout(binding = k_airlight_unit) uniform sampler2D coarse_airlight_image;
layout(location = 0) out vec4 airlight;

// Relative, below which depths count as alike: what a slanted surface changes from pixel to pixel.
const float k_alike = 0.02;
const float k_sky = 1e30;  // [m]

float distance_seen(vec4 surface) { return surface.w == 0.0 ? k_sky : surface.w; }

void main() {
  ivec2 coarse_size = textureSize(coarse_airlight_image, 0);
  float distance = distance_seen(texelFetch(surface_image, ivec2(gl_FragCoord.xy), 0));
  vec2 place = place_in_image(gl_FragCoord.xy, vec2(textureSize(surface_image, 0)), vec2(coarse_size)) - 0.5;
  vec2 first = floor(place);
  vec2 share = place - first;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 corner = vec2(i & 1, i >> 1);
    ivec2 texel = clamp(ivec2(first + corner), ivec2(0), coarse_size - 1);
    float other = distance_seen(texelFetch(coarse_surface_image, texel, 0));
    vec2 near = mix(1.0 - share, share, corner);
    // Never 0: where none of those beside the pixel sees its surface, one a little farther does.
    float difference = abs(other - distance) / max(other, distance);
    float weight = (near.x * near.y + 1e-3) / (difference * difference + k_alike * k_alike);
    sum += weight * texelFetch(coarse_airlight_image, texel, 0).rgb;
    weights += weight;
  }
  airlight = vec4(sum / weights, 1.0);
}
