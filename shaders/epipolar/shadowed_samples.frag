#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "epipolar/grid_texels.glsl"
#include "epipolar/phi_range.glsl"

// How many of the samples along each pixel's view ray are in shadow, of all N_φ (Fig. 7, bottom): set bits of its row whose
// centre lies before the end of the ray.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) out float fraction;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 direction = view_ray(camera, vec2(pixel) + 0.5);
  EyeAngle angle = eye_angle(space, direction, quarter_pixel(camera));
  float t = texelFetch(surface_image, pixel, 0).w;
  float phi_end = phi_of_end(space, angle, t, t <= 0.0);
  uint i = alpha_cell(space, alpha_of(angle), k_alpha_count);
  uint j = theta_cell(space, theta_of(space, direction), k_theta_count);
  int end = int(clamp(ceil(cell_of_phi(phi_cells(j), phi_end) - 0.5), 0.0, float(k_phi_count)));
  int count = 0;
  for (int first = 0; first < end; first += 128) {
    uvec4 words = grid_bits(j, i, uint(first) >> 7);
    for (int word = 0; word < 4; ++word) {
      int wanted = clamp(end - first - 32 * word, 0, 32);
      uint mask = wanted == 32 ? 0xffffffffu : (1u << uint(wanted)) - 1u;
      count += bitCount(words[word] & mask);
    }
  }
  fraction = float(count) / float(k_phi_count);
}
