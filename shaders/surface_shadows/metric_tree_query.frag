#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/metric_tree_walk.glsl"
#include "surface_shadows/surface_query.glsl"

// What of the light arrives at the point that the pixel shades.
layout(location = 0) out vec4 visibility;

layout(constant_id = 0) const uint k_counts = 0;  // writes instead how many of these were visited or asked: 1 nodes, 2 clusters, …
const uint k_counts_nodes = 1u;
const uint k_counts_clusters = 2u;
const uint k_counts_triangles = 3u;  // … 3 triangles

void main() {
  visibility = vec4(light_at_surface(ivec2(gl_FragCoord.xy)), 1.0);
  if (k_counts == k_counts_nodes) visibility = vec4(visited_nodes);
  if (k_counts == k_counts_clusters) visibility = vec4(asked_clusters);
  if (k_counts == k_counts_triangles) visibility = vec4(asked_triangles);
}
