#version 450
#extension GL_GOOGLE_include_directive : require
#define COLOUR_BUILD
#include "epipolar/uniforms.glsl"
#include "frame/light_colour.glsl"
#include "media/vsv_colour.glsl"

// The table of vsv_colour.glsl. One invocation a row.
layout(local_size_x = 8) in;
layout(binding = k_light_texture_unit) uniform sampler2D light_texture;
layout(std430, binding = k_table_storage) writeonly buffer Colours { vec4 colours[]; };

// Samples that a texel of latitude has, and a column at most.
const float k_samples = 2.0;
const float k_most_samples = 8.0;

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= k_colour_rows) return;
  float theta = space.theta_middle + theta_of_colour_row(row);
  vec3 outward = cosine(theta) * space.u + sine(theta) * space.f;
  float step = colour_step();
  float samples = clamp(ceil(k_samples * float(textureSize(light_texture, 0).y) * step / k_pi), 1.0, k_most_samples);
  float width = step / samples;
  vec4 sum = vec4(0.0);
  for (uint column = 0u; column <= k_colour_columns; ++column) {
    colours[colour_row_start(row) + column] = sum;
    for (float i = 0.5; i < samples; ++i) {
      float phi = float(column) * step + i * width;
      vec3 colour = light_colour(light_texture, sine(phi) * outward - cosine(phi) * space.axis);
      sum += width * vec4(colour, phi * dot(colour, vec3(1.0 / 3.0)));
    }
  }
}
