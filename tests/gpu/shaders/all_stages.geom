#version 450
layout(triangles) in;
layout(triangle_strip, max_vertices = 6) out;
layout(constant_id = 3) const uint k_bit = 0;
layout(location = 0) in uint bits[];
layout(location = 0) flat out uint out_bits;

// Every triangle into each of two layers.
void main() {
  for (int layer = 0; layer < 2; ++layer) {
    for (int i = 0; i < 3; ++i) {
      gl_Layer = layer;
      gl_Position = gl_in[i].gl_Position;
      out_bits = bits[i] | (layer == 0 ? k_bit : 0u);
      EmitVertex();
    }
    EndPrimitive();
  }
}
