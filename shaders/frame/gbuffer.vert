#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/view.glsl"

layout(std140, binding = 0) uniform ViewUniform { ViewBlock view; };

layout(location = 0) in vec3 position;
layout(location = 1) in uint first_triangle;  // one a draw: gl_PrimitiveID counts from it
layout(location = 0) flat out uint out_first_triangle;

void main() {
  vec3 point = eye_relative(view, position);
  float depth = dot(point, view.forward);
  gl_Position = vec4(dot(point, view.right) / view.half_width, dot(point, view.up) / view.half_height, view.eye_near, depth);
  out_first_triangle = first_triangle;
}
