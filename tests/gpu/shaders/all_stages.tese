#version 450
layout(quads) in;
layout(constant_id = 2) const uint k_bit = 0;
layout(location = 0) in uint bits[];
layout(location = 0) out uint out_bits;

void main() {
  vec4 bottom = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x);
  vec4 top = mix(gl_in[2].gl_Position, gl_in[3].gl_Position, gl_TessCoord.x);
  gl_Position = mix(bottom, top, gl_TessCoord.y);
  out_bits = bits[0] | k_bit;
}
