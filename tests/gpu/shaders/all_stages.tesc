#version 450
layout(vertices = 4) out;
layout(constant_id = 1) const uint k_bit = 0;
layout(location = 0) in uint bits[];
layout(location = 0) out uint out_bits[];

void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  out_bits[gl_InvocationID] = bits[gl_InvocationID] | k_bit;
  gl_TessLevelOuter = float[4](2.0, 2.0, 2.0, 2.0);
  gl_TessLevelInner = float[2](2.0, 2.0);
}
