#version 450
layout(constant_id = 0) const uint k_bit = 0;
layout(location = 0) out uint bits;

void main() {
  gl_Position = vec4((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0, 0.0, 1.0);
  bits = k_bit;
}
