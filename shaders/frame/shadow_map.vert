#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "frame/shadow_cube.glsl"
#include "frame/shadow_plane.glsl"

layout(constant_id = 0) const bool k_plane = false;
// Of a cube, which is a function of the light alone: the eye's rounding is none of its own.
layout(location = 0) uniform int face;
layout(location = 1) uniform vec3 light_high;  // the light, world space [m], rounded to float …
layout(location = 2) uniform vec3 light_low;   // … and what the rounding left
layout(location = 0) in vec3 position;
layout(location = 1) in uint first_triangle;  // as of gbuffer.vert, …
layout(location = 2) in vec2 texture_place;   // … both of cut-outs alone
layout(location = 0) flat out uint out_first_triangle;
layout(location = 1) out vec2 out_texture_place;

void main() {
  out_first_triangle = first_triangle;
  out_texture_place = texture_place;
  if (k_plane) {
    gl_Position = plane_clip(light, eye_relative(camera, position));
    return;
  }
  vec3 d = relative_to(light_high, light_low, position);
  int axis = face >> 1;
  vec3 rotated = axis == 0 ? d.xyz : axis == 1 ? d.yzx : d.zxy;  // (along, u, v)
  float depth = (face & 1) == 0 ? rotated.x : -rotated.x;
  // The image's rows run downwards, so v does too.
  gl_Position = vec4(rotated.y, -rotated.z, light.near, depth);
}
