#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/camera.glsl"
#include "frame/shadow_cube.glsl"

layout(location = 0) uniform int face;
layout(location = 0) in vec3 position;

void main() {
  vec3 d = eye_relative(camera, position) - light.from_eye;
  int axis = face >> 1;
  vec3 rotated = axis == 0 ? d.xyz : axis == 1 ? d.yzx : d.zxy;  // (along, u, v)
  float depth = (face & 1) == 0 ? rotated.x : -rotated.x;
  // The image's rows run downwards, so v does too.
  gl_Position = vec4(rotated.y, -rotated.z, light.near, depth);
}
