#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/cut_out.glsl"

layout(constant_id = 1) const uint k_cut_outs = 0;
layout(location = 0) flat in uint first_triangle;
layout(location = 1) in vec2 texture_place;

void main() {
  if (k_cut_outs != 0u) {
    if (is_cut_away(first_triangle + uint(gl_PrimitiveID), texture_place)) discard;
  }
}
