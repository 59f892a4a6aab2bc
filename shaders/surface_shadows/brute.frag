#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/occluders.glsl"
#include "surface_shadows/transmission.glsl"

// Asks every triangle.
layout(location = 1) uniform float scale;
layout(location = 2) uniform uint triangle_count;
layout(location = 0) out vec4 visibility;

vec3 light_at(vec3 point, uint own_plane) {
  begin_point();
  LightRays rays = light_rays();
  for (uint triangle = 0u; triangle < triangle_count && !is_hidden; ++triangle)
    if (least_distance_of(triangle) >= 0.0) meet(rays, occluder(triangle), triangle, point, plane_of(triangle) == own_plane);
  return light_left();
}

#include "surface_shadows/surface_query.glsl"

void main() { visibility = vec4(light_at_surface(ivec2(gl_FragCoord.xy)), 1.0); }
