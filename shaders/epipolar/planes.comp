#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "epipolar/resolution.glsl"

// The table of shaders/epipolar/planes.glsl.
layout(local_size_x = 64) in;
layout(std430, binding = k_planes_storage) writeonly buffer Planes { vec4 planes[]; };

void main() {
  uint j = gl_GlobalInvocationID.x;
  if (j >= k_theta_count) return;
  float theta = theta_centre(space, j);
  planes[2u * j] = vec4(cosine(theta), sine(theta), theta_of_plane(space, float(j)), theta_of_plane(space, float(j + 1u)));
}
