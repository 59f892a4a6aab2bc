#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/ray_ends.glsl"

// Finds the largest φ at which a view ray of this frame ends in each half-plane (section 4.3, for each of them). Many pixels an
// invocation, and neighbours of one half-plane together, so that few atomics remain.
layout(local_size_x = 64) in;
layout(binding = k_surface_unit) uniform sampler2D surface_image;

const uint k_rows = 32u;

void main() {
  uvec2 size = uvec2(camera.image_width, camera.image_height);
  uint x = gl_GlobalInvocationID.x;
  if (x >= size.x) return;
  RayEnds ends = RayEnds(0u, 0.0);
  uint end = min((gl_GlobalInvocationID.y + 1u) * k_rows, size.y);
  for (uint y = gl_GlobalInvocationID.y * k_rows; y < end; ++y)
    see_end(ends, vec2(x, y) + 0.5, texelFetch(surface_image, ivec2(x, y), 0).w);
  note_ends(ends);
}
