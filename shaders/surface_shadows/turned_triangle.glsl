// A triangle of the scene as the predicate wants it (frame/occlusion.glsl). GLSL only; needs frame/uniforms.glsl.
#include "frame/occlusion.glsl"
#include "surface_shadows/light_frame.glsl"

layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions

struct TurnedTriangle {
  Occluder occluder;
  float turn;  // turn_of its corners as they are stored
};

TurnedTriangle turned_triangle(LightRays rays, LightFrame frame, uint number) {
  uvec3 indices = texelFetch(triangles, int(number)).xyz;
  vec3 a = in_light_frame(frame, texelFetch(positions, int(indices.x)).xyz);
  vec3 b = in_light_frame(frame, texelFetch(positions, int(indices.y)).xyz);
  vec3 c = in_light_frame(frame, texelFetch(positions, int(indices.z)).xyz);
  float turn = turn_of(rays, a, b, c);
  bool is_turned = turn < 0.0;
  return TurnedTriangle(Occluder(a, is_turned ? c : b, is_turned ? b : c), turn);
}
