// What a textured light sends along light rays, integrated over φ from 0 on: as the visibility bits do, its colour c depends on (θ, φ)
// alone. So along a lit run any integral ∫ f c dφ, f smooth, is on a panel around m
//   f(m) ∫ c dφ + f'(m) ∫ (φ − m) c dφ + …
// by differences between two entries of a table, however fine the texture is. Rows lie equally far apart over the frame's range of θ,
// at the centres of equal parts, and columns at equal steps of φ. An entry is (∫ c dφ, ∫ φ c̄ dφ), c̄ the mean of the channels. GLSL
// only; needs uniforms.glsl.
layout(constant_id = 14) const uint k_colour_rows = 1024;
layout(constant_id = 15) const uint k_colour_columns = 512;

float colour_step() { return (k_pi - space.alpha_min) / float(k_colour_columns); }

// The first entry of a row.
uint colour_row_start(uint row) { return row * (k_colour_columns + 1u); }

// θ of a row, from the middle of the frame's range.
float theta_of_colour_row(uint row) {
  return space.theta_half * (2.0 * (float(row) + 0.5) / float(k_colour_rows) - 1.0);
}

#ifndef COLOUR_BUILD
layout(binding = k_table_unit) uniform samplerBuffer colours;  // vec4

// The two rows that a half-plane lies between, by their first entries.
struct ColourRows {
  int first;
  int second;
  float blend;
};

ColourRows colour_rows(float theta) {
  float place = (theta_from_middle(space, theta) / space.theta_half + 1.0) * (0.5 * float(k_colour_rows)) - 0.5;
  int lower = int(floor(place));
  int last = int(k_colour_rows) - 1;
  bool is_turn = space.theta_half == k_pi;
  ColourRows rows;
  rows.blend = place - float(lower);
  rows.first = int(colour_row_start(uint(lower < 0 ? is_turn ? last : 0 : min(lower, last))));
  rows.second = int(colour_row_start(uint(lower >= last ? is_turn ? 0 : last : lower + 1)));
  return rows;
}

// The integrals up to φ.
vec4 colours_to(ColourRows rows, float phi) {
  float at = clamp(phi / colour_step(), 0.0, float(k_colour_columns));
  float column = min(floor(at), float(k_colour_columns) - 1.0);
  float blend = at - column;
  int k = int(column);
  vec4 before = mix(texelFetch(colours, rows.first + k), texelFetch(colours, rows.second + k), rows.blend);
  vec4 after = mix(texelFetch(colours, rows.first + k + 1), texelFetch(colours, rows.second + k + 1), rows.blend);
  vec4 sum = mix(before, after, blend);
  // Within a column c is taken for constant, so that ∫ φ c̄ dφ is a parabola.
  sum.w -= 0.5 * blend * (1.0 - blend) * colour_step() * dot(after.rgb - before.rgb, vec3(1.0 / 3.0));
  return sum;
}
#endif
