#version 450
#extension GL_GOOGLE_include_directive : require
#define COLOUR_BUILD
#include "epipolar/uniforms.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/planes.glsl"
#include "frame/light_colour.glsl"
#include "media/vsv_colour.glsl"

// The table of vsv_colour.glsl. One invocation a half-plane.
layout(local_size_x = 8) in;
layout(binding = k_light_texture_unit) uniform sampler2D light_texture;
layout(std430, binding = k_table_storage) writeonly buffer Colours { vec4 colours[]; };

// Samples of a column: two, or as many as there are half texels of latitude.
const float k_most_samples = 8.0;

void main() {
  uint j = gl_GlobalInvocationID.x;
  if (j >= k_theta_count) return;
  vec2 direction = plane_direction(j);
  vec3 outward = direction.x * space.u + direction.y * space.f;
  float step = colour_step();
  float samples = clamp(ceil(2.0 * float(textureSize(light_texture, 0).y) * step / k_pi), 2.0, k_most_samples);
  float width = step / samples;
  vec4 sum = vec4(0.0);
  for (uint k = 0u; k <= k_phi_count; ++k) {
    colours[colour_index(j, k)] = sum;
    for (float i = 0.5; i < samples; ++i) {
      float phi = float(k) * step + i * width;
      vec3 colour = light_colour(light_texture, sine(phi) * outward - cosine(phi) * space.axis);
      sum += width * vec4(colour, phi * dot(colour, vec3(1.0 / 3.0)));
    }
  }
}
