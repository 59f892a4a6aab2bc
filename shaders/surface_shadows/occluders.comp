#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "frame/occlusion.glsl"

// Makes the occluders (occluders.glsl), one an invocation.
layout(local_size_x = 64) in;
layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions
layout(binding = k_parts_unit) uniform usamplerBuffer parts;          // of which part a triangle is
layout(binding = k_is_culled_unit) uniform usamplerBuffer is_culled;  // whether those of a part that face the light are left out
layout(std430, binding = k_occluders_storage) writeonly buffer Occluders { vec4 corners[]; };
layout(location = 0) uniform vec3 origin_high;
layout(location = 1) uniform vec3 origin_low;
layout(location = 2) uniform uint triangle_count;
layout(location = 3) uniform float scale;

layout(constant_id = 0) const bool k_culls = false;

// A length that the light is at least from any point of the triangle: along the way to its middle, rounded down.
float least_distance(vec3 a, vec3 b, vec3 c) {
  vec3 way = unit_or(a + b + c, a);
  float least = min(dot(way, a), min(dot(way, b), dot(way, c)));
  float largest = max(length(a), max(length(b), length(c)));
  return max(least - 2e-6 * largest, 0.0);
}

void main() {
  uint number = gl_GlobalInvocationID.x;
  if (number >= triangle_count) return;
  uvec3 indices = texelFetch(triangles, int(number)).xyz;
  vec3 a = scale * relative_to(origin_high, origin_low, texelFetch(positions, int(indices.x)).xyz);
  vec3 b = scale * relative_to(origin_high, origin_low, texelFetch(positions, int(indices.y)).xyz);
  vec3 c = scale * relative_to(origin_high, origin_low, texelFetch(positions, int(indices.z)).xyz);
  float turn = turn_of(LightRays(-light.from_eye, light.is_near == 0.0), a, b, c);
  bool hides_nothing = turn == 0.0;
  if (k_culls) {
    if (turn < 0.0) hides_nothing = texelFetch(is_culled, int(texelFetch(parts, int(number)).x)).x != 0u;
  }
  if (turn < 0.0) {
    vec3 other = b;
    b = c;
    c = other;
  }
  corners[3u * number] = vec4(a, hides_nothing ? -1.0 : least_distance(a, b, c));
  corners[3u * number + 1u] = vec4(b, 0.0);
  corners[3u * number + 2u] = vec4(c, 0.0);
}
