#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/occluders.glsl"
#include "surface_shadows/top_tree.glsl"

// Inserts every triangle, one an invocation, in a random order: each goes down the tree and becomes the child at the first place that
// has none (Algorithm 1). A place is taken by compare-and-swap. A wedge grows by an atomic maximum of a float's bits, which order
// as the numbers do where none is negative; a subtree's least depth sinks by an atomic minimum.
layout(local_size_x = 64) in;
layout(binding = k_insertion_order_unit) uniform usamplerBuffer insertion_order;
layout(binding = k_tree_planes_unit) uniform samplerBuffer planes;
layout(std430, binding = k_tree_links_storage) coherent buffer Links { uint links[]; };
layout(std430, binding = k_subtrees_storage) buffer Subtrees { uint subtrees[]; };
layout(location = 0) uniform uint triangle_count;
layout(location = 1) uniform float scene_reach;

void main() {
  uint place_in_order = gl_GlobalInvocationID.x;
  if (place_in_order >= triangle_count) return;
  uint triangle = texelFetch(insertion_order, int(place_in_order)).r;
  float least_distance = least_distance_of(triangle);
  if (least_distance < 0.0) return;
  LightRays rays = light_rays();
  Occluder own = occluder(triangle);
  vec3 corners[3] = vec3[3](own.a, own.b, own.c);

  uint node = k_none;  // where to look on, or none: at a place for a child,
  uint place = 0u;     // this word
  bool is_inserted = false;
  uint own_depth = subtrees[2u * triangle + 1u];
  while (!is_inserted) {
    if (node == k_none) {
      uint child = links[place];
      // Read before another invocation wrote, it may be 0 no longer.
      if (child == 0u) child = atomicCompSwap(links[place], 0u, triangle + 1u);
      is_inserted = child == 0u;
      if (is_inserted) subtrees[2u * triangle] = place;
      node = first_node_of(child);
      if (!is_inserted) atomicMin(subtrees[2u * (child - 1u) + 1u], own_depth);
    } else {
      uint k = node & 3u;
      vec4 plane = texelFetch(planes, int(node));
      Occluder other = occluder(node >> 2);
      vec3 first = k == 1u ? other.b : k == 2u ? other.c : other.a;
      vec3 second = k == 0u ? other.b : k == 1u ? other.c : k == 2u ? other.a : other.b;
      vec3 third = k == 3u ? other.c : first;
      float slack = uintBitsToFloat(links[4u * (node + 1u) + (k == 3u ? k_slack_of_last : k_slack_of_edge)]);
      bool is_outside = true;
      bool is_inside = true;
      float highest = 0.0;
      for (uint i = 0u; i < 3u; ++i) {
        float distance = length(corners[i]);
        float height = height_above(plane, corners[i]);
        float error = slack_at(node, slack, distance, scene_reach, rays.is_sun);
        bool is_shared = corners[i] == first || corners[i] == second || corners[i] == third;
        is_outside = is_outside && (is_shared || height > error);
        is_inside = is_inside && (is_shared || height < -error);
        highest = max(highest, abs(height) + k_height_error * (distance + scene_reach));
      }
      if (!is_outside && !is_inside && k < 3u) {
        float wedge = rays.is_sun ? highest : highest < 1e6 * least_distance ? highest / least_distance : 1e6;
        atomicMax(links[4u * (node + 1u) + k_wedge], floatBitsToUint(1.00001 * wedge));
      }
      if (is_inside && !is_outside && k < 3u) {
        ++node;
      } else {
        place = 4u * (node + 1u) + (is_outside ? k_outside : is_inside ? k_inside_of_last : k_intersected);
        node = k_none;
      }
    }
  }
}
