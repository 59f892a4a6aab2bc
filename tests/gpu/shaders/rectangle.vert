#version 450

// A strip of two triangles over the whole height of the image.
layout(location = 0) uniform uvec4 shape;  // from, to and depth, in eighths of clip space's sides; 1 to turn it over

void main() {
  float x = float((gl_VertexID & 1) == int(shape.w) ? shape.x : shape.y) / 4.0 - 1.0;
  gl_Position = vec4(x, (gl_VertexID & 2) == 0 ? -1.0 : 1.0, float(shape.z) / 8.0, 1.0);
}
