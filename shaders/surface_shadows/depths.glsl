// Depths in a light: the distance from a lamp, or the place along a sun's rays. GLSL only.

// A depth as an unsigned number of the same order.
uint ordered(float depth) {
  uint bits = floatBitsToUint(depth);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

// Of what rounding leaves of a depth, of the lengths that it is made from.
const float k_depth_error = 2e-6;
