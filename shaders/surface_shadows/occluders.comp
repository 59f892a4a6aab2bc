#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/turned_triangle.glsl"

// Makes the occluders (occluders.glsl), one an invocation.
layout(local_size_x = 64) in;
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
  TurnedTriangle triangle = turned_triangle(light_rays(), LightFrame(origin_high, origin_low, scale), number);
  Occluder occluder = triangle.occluder;
  bool hides_nothing = triangle.turn == 0.0;
  if (k_culls) {
    if (triangle.turn < 0.0) hides_nothing = texelFetch(is_culled, int(texelFetch(parts, int(number)).x)).x != 0u;
  }
  corners[3u * number] = vec4(occluder.a, hides_nothing ? -1.0 : least_distance(occluder.a, occluder.b, occluder.c));
  corners[3u * number + 1u] = vec4(occluder.b, 0.0);
  corners[3u * number + 2u] = vec4(occluder.c, 0.0);
}
