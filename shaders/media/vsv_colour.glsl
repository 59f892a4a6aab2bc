// What a textured light sends along the light rays of a half-plane, integrated from φ = 0 on: as the visibility bits do, its colour c
// depends on (θ, φ) alone. So along a lit run any integral ∫ f c dφ of something smooth f is, on a panel,
//   f(m) ∫ c dφ + f'(m) ∫ (φ − m) c dφ + …
// by differences of two tables, however fine the texture is. Rows lie at the centres of half-planes, columns at equal steps of φ. An
// entry is (∫ c dφ, ∫ φ c̄ dφ), c̄ the mean of the channels. GLSL only; needs uniforms.glsl and resolution.glsl.

float colour_step() { return (k_pi - space.alpha_min) / float(k_phi_count); }

uint colour_index(uint plane, uint column) { return plane * (k_phi_count + 1u) + column; }

#ifndef COLOUR_BUILD
layout(binding = k_table_unit) uniform samplerBuffer colours;  // vec4

// Between which two rows a half-plane lies.
struct ColourRow {
  int first;
  int second;
  float blend;
};

ColourRow colour_row(float theta) {
  float place = plane_of_theta(space, theta_from_middle(space, theta)) - 0.5;
  int lower = int(floor(place));
  int last = int(k_theta_count) - 1;
  bool is_turn = space.theta_half == k_pi;
  ColourRow row;
  row.blend = place - float(lower);
  row.first = int(colour_index(uint(lower < 0 ? is_turn ? last : 0 : min(lower, last)), 0u));
  row.second = int(colour_index(uint(lower >= last ? is_turn ? 0 : last : max(lower + 1, 0)), 0u));
  return row;
}

// The integrals up to φ.
vec4 colours_to(ColourRow row, float phi) {
  float at = clamp(phi / colour_step(), 0.0, float(k_phi_count));
  float column = min(floor(at), float(k_phi_count) - 1.0);
  float blend = at - column;
  int k = int(column);
  return mix(mix(texelFetch(colours, row.first + k), texelFetch(colours, row.first + k + 1), blend),
             mix(texelFetch(colours, row.second + k), texelFetch(colours, row.second + k + 1), blend), row.blend);
}
#endif
