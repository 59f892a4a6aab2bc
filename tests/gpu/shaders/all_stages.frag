#version 450
layout(constant_id = 4) const uint k_bit = 0;
layout(location = 0) flat in uint bits;
layout(location = 0) out uint colour;

void main() { colour = bits | k_bit; }
