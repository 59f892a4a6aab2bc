// What the VSV integrators share: a pixel's view ray in the grid. GLSL only.
#include "frame/view.glsl"
#include "epipolar/grid.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "media/medium.glsl"

layout(constant_id = 3) const uint k_phase = 0;

layout(std140, binding = 0) uniform ViewUniform { ViewBlock view; };
layout(std140, binding = 1) uniform EpipolarUniform { EpipolarBlock space; };
layout(std140, binding = 2) uniform MediumUniform { MediumBlock medium; };
layout(binding = 0) uniform sampler2D distance_image;
layout(binding = 12) uniform usamplerBuffer grid_texels;
layout(binding = 0, rgba32f) uniform writeonly image2D airlight_image;

struct VsvRay {
  EyeAngle angle;
  float alpha;
  float complement;  // π − α
  float phi_end;     // where the ray ends
  PhiCells cells;
  float end;         // where it ends, in cells of φ
  uint last_cell;    // the cell that holds its end
  int texel;         // the first texel of its row of bits
  bool is_open;      // meets no surface
};

VsvRay vsv_ray(ivec2 pixel) {
  VsvRay ray;
  vec3 direction = view_ray(view, vec2(pixel) + 0.5);
  ray.angle = eye_angle(space, direction, quarter_pixel(view));
  ray.alpha = alpha_of(ray.angle);
  ray.complement = alpha_complement(ray.angle);
  float t = texelFetch(distance_image, pixel, 0).r;
  ray.is_open = t == 0.0;
  ray.phi_end = ray.is_open ? ray.complement : phi_at(space, ray.angle, t);
  ray.cells = phi_cells();
  ray.end = cell_of_phi(ray.cells, ray.phi_end);
  ray.last_cell = uint(clamp(floor(ray.end), 0.0, float(k_phi_count) - 1.0));
  uint i = alpha_cell(space, ray.alpha, k_alpha_count);
  uint j = theta_cell(theta_of(space, direction), k_theta_count);
  ray.texel = int((j * k_alpha_count + i) * k_texels_per_ray);
  return ray;
}

// Bits 0 to `count` − 1 of a word.
uint low_bits(uint count) { return count >= 32u ? 0xffffffffu : (1u << count) - 1u; }
