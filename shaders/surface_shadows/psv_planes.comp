#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/occluders.glsl"
#include "surface_shadows/top_tree.glsl"

// Writes the nodes of every triangle, without children; one triangle an invocation. In a dispatch of its own, so that whoever is led to
// a node while the tree grows finds it written.
layout(local_size_x = 64) in;
layout(std430, binding = k_tree_planes_storage) writeonly buffer Planes { vec4 planes[]; };
layout(std430, binding = k_tree_links_storage) writeonly buffer Links { uvec4 links[]; };
layout(std430, binding = k_subtrees_storage) writeonly buffer Subtrees { uvec2 subtrees[]; };
layout(location = 0) uniform uint triangle_count;
layout(location = 1) uniform float scene_reach;  // as in psv_query.frag

// A normal of cross(u, v), scaled to unit length, and by how much at most its direction is off; `slack` includes what computing a
// height adds. Each component of the product is off by 3 roundings of its terms and one of each factor that is a difference.
vec3 unit_normal(vec3 u, vec3 v, out float slack) {
  vec3 normal = cross(u, v);
  float size = length(normal);
  float off = 1.2e-6 * length(u) * length(v);
  slack = off < 0.25 * size ? 1.1 * off / size + 1e-6 + k_height_error : 4.0;
  return size > 0.0 ? normal / size : vec3(1.0, 0.0, 0.0);
}

void main() {
  uint triangle = gl_GlobalInvocationID.x;
  if (triangle == 0u) links[0] = uvec4(0u);
  if (triangle >= triangle_count) return;
  LightRays rays = light_rays();
  Occluder occluder = occluder(triangle);
  vec3 corners[3] = vec3[3](occluder.a, occluder.b, occluder.c);
  float slack;
  for (uint k = 0u; k < 3u; ++k) {
    vec3 from = corners[k];
    vec3 edge = corners[k == 2u ? 0u : k + 1u] - from;
    vec3 normal = -unit_normal(rays.is_sun ? rays.travels : from, edge, slack);
    planes[4u * triangle + k] = vec4(normal, rays.is_sun ? -ordered_dot(normal, from) : 0.0);
    links[4u * triangle + k + 1u] = uvec4(0u, 0u, floatBitsToUint(0.0), floatBitsToUint(slack));
  }
  vec3 normal = -unit_normal(occluder.b - occluder.a, occluder.c - occluder.a, slack);
  planes[4u * triangle + 3u] = vec4(normal, -ordered_dot(normal, occluder.a));
  links[4u * triangle + 4u] = uvec4(0u, 0u, floatBitsToUint(slack), 0u);
  float along_a = ordered_dot(rays.travels, occluder.a);
  float along_b = ordered_dot(rays.travels, occluder.b);
  float along_c = ordered_dot(rays.travels, occluder.c);
  float least_depth =
      rays.is_sun ? min(along_a, min(along_b, along_c)) - k_depth_error * scene_reach : least_distance_of(triangle);
  subtrees[triangle] = uvec2(0u, ordered(least_depth));
}
