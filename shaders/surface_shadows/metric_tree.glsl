// The ternary metric tree: a node a cluster of triangles, which holds what the light sees of the cluster's capsule, the node's pivot.
// A capsule inserted later lies wholly within the node's distance δ of the pivot's arc, wholly beyond, or both, and goes to that child.
//
// δ is stored nowhere: it is that of the whole scene at the root and half as much after each step to what is near, so that who
// goes down the tree carries it. (The tree that the CPU makes, surface_shadows/median_tree.h, has medians, and brings them.)
// Node k is that of cluster k − 1 and node 0 stands before the root: the addresses follow from the clusters' numbers,
// nothing is allocated, and a tree of n clusters takes 64 n + 64 bytes.
//
// What must not be lost: distances are rounded, so a capsule is near, or beyond, only where the distance is clear of δ by `slack`,
// at least the errors of the insertion's distances and of a query's together; else it counts as both. So a point asks one of the two.
//
// Based on: Deves, Mora, Aveneau, Ghazanfarpour, "Scalable Real-Time Shadows using Clustering and Metric Trees", EGSR 2018,
// sections 5.1, 5.3 and 5.4. What differs: apparent.glsl's distances; a cluster that the light is in, or nearly, has no
// place in the tree and is always asked.
// GLSL only.
#include "surface_shadows/apparent.glsl"
#include "surface_shadows/depths.glsl"

const float k_no_place = -1.0;

struct MetricNode {
  vec3 from;           // of the pivot's arc
  float width;         // k_no_place of a cluster that is not in the tree
  vec3 to;
  uint least_depth;    // `ordered`, of the pivot and of all below it
  uint children[3];    // 0 for none; node 0's first is the root
  uint place;          // which of whose children it is: 4 · node + child; of node 0: how many clusters are always asked
  uint overlap_least;  // bits of the least d_near and the greatest d_far of what is below the third child
  uint overlap_most;
  uint depth;          // `ordered`, of the pivot
  uint leaves_out_fronts;  // 1 where the cluster's triangles that face the light are culled
};

// A cluster of triangles (surface_shadows/triangle_clusters.h).
struct MetricCluster {
  Capsule capsule;  // world space [m]
  float opening;
  vec3 axis;
  float least_altitude;
  float lower;
  float upper;
  uint first;
  uint count;
  uint part;  // 0 for none
};

const uint k_part_unit = 1024u;

// Of its four texels.
MetricCluster cluster_of(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
  vec4 from = uintBitsToFloat(a);
  vec4 to = uintBitsToFloat(b);
  vec4 axis = uintBitsToFloat(c);
  vec2 slabs = uintBitsToFloat(d.xy);
  return MetricCluster(Capsule(from.xyz, to.xyz, from.w), to.w, axis.xyz, axis.w, slabs.x, slabs.y, d.z, d.w % k_part_unit,
                       d.w / k_part_unit);
}

// δ after some steps to what is near: an exact power of two less than the root's.
float partition_distance(float of_root, uint near_steps) { return uintBitsToFloat(floatBitsToUint(of_root) - (near_steps << 23)); }
