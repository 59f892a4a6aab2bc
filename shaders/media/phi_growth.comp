#version 450
#extension GL_GOOGLE_include_directive : require
#define PHI_RANGE_ACCESS
#include "epipolar/uniforms.glsl"
#include "epipolar/phi_range.glsl"
#include "media/layer.glsl"

// Chooses how the cells in φ grow, so that samples go where light comes from.
//
// A change of visibility is misplaced by up to half a cell, an error of the integrand f times the cell's width. For changes
// spread evenly over φ the sum of squared errors is least when cells are as dense as f^(2/3). The one parameter of
// phi_of_cell is set so that half of the cells lie where half of that density does, on the view ray in the middle of
// the frame's range of α.
layout(local_size_x = 1) in;
layout(constant_id = 3) const uint k_phase = 0;

const uint k_steps = 128u;
// Where the light is in view: rays near the axis span little of φ, and have few cells else.
const float k_least_growth = 2.0;
const float k_most_growth = 4.0;  // far shadows keep at least a third of the density that equal cells would give them

void main() {
  float phi_max = largest_phi();
  float alpha = 0.5 * (space.alpha_min + alpha_of_cell(space, float(k_alpha_count)));
  float complement = k_pi - alpha;
  LayerRay ray = LayerRay(vec3(0.0), vec3(0.0), alpha, complement, 0.0);
  float density[k_steps];
  float total = 0.0;
  for (uint i = 0u; i < k_steps; ++i) {
    float phi = phi_max * (float(i) + 0.5) / float(k_steps);
    vec3 f;
    if (is_sun(space) || medium.top < 0.0 || light.from_eye.y > medium.top) {
      // What counts is the eye's path in the medium, and of one that enters it somewhere nothing is known.
      float path = is_sun(space) ? phi / max(sine(alpha), 1e-3) : layer_distance(space, ray, phi);
      f = integrand_of_path(medium, k_phase, medium.top < 0.0 ? 0.0 : path, complement, is_sun(space) ? 0.0 : phi);
    } else {
      f = airlight_integrand(space, medium, k_phase, complement, phi);
    }
    density[i] = pow(max(f.x, max(f.y, f.z)) + 1e-30, 2.0 / 3.0);  // of 0 a logarithm need not be infinite
    total += density[i];
  }
  float sum = 0.0;
  float median = 0.5;
  for (uint i = 0u; i < k_steps; ++i) {
    if (sum <= 0.5 * total && sum + density[i] > 0.5 * total) {
      median = (float(i) + (0.5 * total - sum) / density[i]) / float(k_steps);
    }
    sum += density[i];
  }
  // phi_of_cell(½) = median · φ_max, solved for the growth.
  float growth = median > 0.25 ? (0.5 - median) / (median - 0.25) : k_most_growth;
  float least = space.alpha_spacing == k_root_of_alpha ? k_least_growth : 0.0;
  phi_growth = clamp(growth, least, k_most_growth);
}
