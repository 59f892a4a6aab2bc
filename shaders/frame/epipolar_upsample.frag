#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/samples_around.glsl"
#include "frame/ray_list.glsl"

// A pixel's airlight: of its own ray where it has one, else from the epipolar samples around it whose surfaces are about as deep.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_ray_groups_unit) uniform usamplerBuffer groups;
layout(binding = k_airlight_unit) uniform sampler2D ray_airlight;
layout(binding = k_sample_airlight_unit) uniform sampler2D sample_airlight;
layout(location = 0) out vec4 airlight;

void main() {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  uint squares = (uint(textureSize(surface_image, 0).x) + 3u) / 4u;
  int group = int(((rays.slices * rays.samples) >> 4) + (pixel.y >> 2) * squares + (pixel.x >> 2));
  uint bit = 4u * (pixel.y & 3u) + (pixel.x & 3u);
  uint listed = texelFetch(groups, 2 * group + 1).r;
  if ((listed >> bit & 1u) != 0u) {
    uint before = uint(bitCount(listed & ((1u << bit) - 1u)));
    airlight = vec4(texelFetch(ray_airlight, texel_of_ray(texelFetch(groups, 2 * group).r + before), 0).rgb, 1.0);
  } else {
    vec2 place = vec2(pixel) + 0.5;
    SamplesAround around = samples_around(rays.slices, rays.samples, place, texelFetch(surface_image, ivec2(pixel), 0));
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
      // Never 0, though what the list was made from may have been rounded otherwise.
      vec4 its = texelFetch(sample_airlight, around.texels[i], 0);
      float weight = (around.shares[i] + 1e-3) * (is_alike(around, i, its.a) ? 1.0 : 1e-9);
      sum += weight * its.rgb;
      weights += weight;
    }
    airlight = vec4(airlight_peak(camera, light.axis, light.is_near, place) / weights * sum, 1.0);
  }
}
