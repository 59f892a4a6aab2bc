#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/cut_out.glsl"

layout(constant_id = 0) const uint k_cut_outs = 0;
layout(location = 0) flat in uint first_triangle;
layout(location = 1) in vec2 texture_place;
layout(location = 0) out uint triangle_plus_one;  // 0 where nothing is seen

void main() {
  uint triangle = first_triangle + uint(gl_PrimitiveID);
  if (k_cut_outs != 0u) {
    if (is_cut_away(triangle, texture_place)) discard;
  }
  triangle_plus_one = triangle + 1u;
}
