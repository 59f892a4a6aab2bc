#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/light_frame.glsl"
#include "surface_shadows/metric_tree.glsl"

// Inserts every cluster's cone, one an invocation: each goes down the tree and becomes the child at the first place that has none. A
// place is taken by compare-and-swap. Least and greatest distances and depths are atomic minima and maxima of bits, which
// order as the numbers do. Clusters are numbered at random, so neighbours do not follow each other.
layout(local_size_x = 64) in;
layout(std430, binding = k_metric_tree_storage) coherent buffer Nodes { MetricNode nodes[]; };
layout(location = 0) uniform uint cluster_count;
layout(location = 1) uniform float distance_error;
layout(location = 2) uniform float root_distance;
layout(location = 3) uniform float slack;

void main() {
  uint number = gl_GlobalInvocationID.x;
  if (number >= cluster_count) return;
  uint own = number + 1u;
  Apparent cone = Apparent(nodes[own].from, nodes[own].to, nodes[own].width);
  if (cone.width < 0.0) return;
  Observer observer = Observer(light_rays(), distance_error);
  uint own_depth = nodes[own].depth;

  uint node = 0u;
  uint child = 0u;
  uint near_steps = 0u;
  bool is_inserted = false;
  while (!is_inserted) {
    uint next = nodes[node].children[child];
    // Read before another invocation wrote, it may be 0 no longer.
    if (next == 0u) next = atomicCompSwap(nodes[node].children[child], 0u, own);
    is_inserted = next == 0u;
    if (is_inserted) {
      nodes[own].place = 4u * node + child;
    } else {
      atomicMin(nodes[next].least_depth, own_depth);
      Apparent pivot = Apparent(nodes[next].from, nodes[next].to, nodes[next].width);
      vec2 distances = distances_to(observer, pivot, cone);
      child = side_of(distances, partition_distance(root_distance, near_steps), slack);
      if (child == k_overlap) {
        atomicMin(nodes[next].overlap_least, floatBitsToUint(distances.x));
        atomicMax(nodes[next].overlap_most, floatBitsToUint(distances.y));
      }
      if (child == k_near) ++near_steps;
      node = next;
    }
  }
}
