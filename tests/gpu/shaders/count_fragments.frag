#version 450
layout(std430, binding = 0) buffer Count { uint fragments; };

void main() { atomicAdd(fragments, 1u); }
