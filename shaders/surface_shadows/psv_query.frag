#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/psv_walk.glsl"
#include "surface_shadows/surface_query.glsl"

// What of the light arrives at the point that the pixel shades.
layout(location = 0) out vec4 visibility;

layout(constant_id = 0) const bool k_counts = false;  // writes how many nodes were visited instead

void main() {
  visibility = vec4(light_at_surface(ivec2(gl_FragCoord.xy)), 1.0);
  if (k_counts) visibility = vec4(visited);
}
