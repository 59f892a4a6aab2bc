#version 450
layout(location = 1) uniform uvec4 bits;
layout(location = 0) out uint colour;

void main() { colour = bits.x; }
