#version 450
#extension GL_GOOGLE_include_directive : require
#define PHI_RANGE_ACCESS
#include "epipolar/uniforms.glsl"
#include "epipolar/phi_range.glsl"

// Finds the largest φ at which a view ray of this frame ends in each half-plane (section 4.3, for each of them). Many pixels an
// invocation, and neighbours of one half-plane together, so that few atomics remain.
layout(local_size_x = 64) in;
layout(binding = k_surface_unit) uniform sampler2D surface_image;

const uint k_rows = 32u;

void main() {
  uvec2 size = uvec2(camera.image_width, camera.image_height);
  uint x = gl_GlobalInvocationID.x;
  if (x >= size.x) return;
  uint plane = 0u;
  float largest = 0.0;
  uint end = min((gl_GlobalInvocationID.y + 1u) * k_rows, size.y);
  for (uint y = gl_GlobalInvocationID.y * k_rows; y < end; ++y) {
    vec2 pixel = vec2(x, y);
    // α and θ from the same two coordinates across the axis: a range need not have every digit near it.
    vec3 direction = view_ray(camera, pixel + 0.5);
    vec2 across = vec2(dot(direction, space.u), dot(direction, space.f));
    EyeAngle angle = kept_off_axis(length(across), dot(direction, space.axis), quarter_pixel(camera));
    float t = texelFetch(surface_image, ivec2(pixel), 0).w;
    float order = t > 0.0 ? phi_order_at(space, angle, t) : phi_order_of_open_end(space, angle);
    uint j = theta_cell(space, angle_of(across.y, across.x), k_theta_count);
    if (j != plane) {
      if (largest > uintBitsToFloat(seen[plane])) atomicMax(seen[plane], floatBitsToUint(largest));
      plane = j;
      largest = 0.0;
    }
    largest = max(largest, order);
  }
  if (largest > 0.0) atomicMax(seen[plane], floatBitsToUint(largest));
}
