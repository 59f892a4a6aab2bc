#version 450
#extension GL_GOOGLE_include_directive : require
#define PHI_RANGE_ACCESS
#include "epipolar/uniforms.glsl"
#include "epipolar/phi_range.glsl"

// Finds the largest φ at which a view ray of this frame ends (section 4.3). Many pixels an invocation, so that few
// atomics remain.
layout(local_size_x = 64) in;
layout(binding = k_surface_unit) uniform sampler2D surface_image;

const uint k_rows = 32u;

void main() {
  uvec2 size = uvec2(camera.image_width, camera.image_height);
  uint x = gl_GlobalInvocationID.x;
  if (x >= size.x) return;
  float largest = 0.0;
  uint end = min((gl_GlobalInvocationID.y + 1u) * k_rows, size.y);
  for (uint y = gl_GlobalInvocationID.y * k_rows; y < end; ++y) {
    vec2 pixel = vec2(x, y);
    EyeAngle angle = eye_angle(space, view_ray(camera, pixel + 0.5), quarter_pixel(camera));
    float t = texelFetch(surface_image, ivec2(pixel), 0).w;
    float order = t > 0.0 ? angle_order(t * angle.sine, space.distance - t * angle.cosine)
                          : angle_order(angle.sine, -angle.cosine);  // φ = π − α where nothing is hit
    largest = max(largest, order);
  }
  atomicMax(largest_order, floatBitsToUint(largest));
}
