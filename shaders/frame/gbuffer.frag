#version 450
layout(location = 0) flat in uint first_triangle;
layout(location = 0) out uint triangle_plus_one;  // 0 where nothing is seen

void main() { triangle_plus_one = first_triangle + uint(gl_PrimitiveID) + 1u; }
