#version 450
layout(location = 1) uniform uvec4 eighths;
layout(location = 0) out vec4 colour;

void main() { colour = vec4(eighths) / 8.0; }
