#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uint first_triangle;  // one a draw: gl_PrimitiveID counts from it
layout(location = 2) in vec2 texture_place;   // of cut-outs
layout(location = 0) flat out uint out_first_triangle;
layout(location = 1) out vec2 out_texture_place;

void main() {
  vec3 point = eye_relative(camera, position);
  float depth = dot(point, camera.forward);
  gl_Position = vec4(dot(point, camera.right) / camera.half_width, dot(point, camera.up) / camera.half_height, camera.near, depth);
  out_first_triangle = first_triangle;
  out_texture_place = texture_place;
}
