#version 450
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "epipolar/change_tree.glsl"
#include "epipolar/resolution.glsl"

// Two levels of the tree, from light rays or from the level below: an invocation makes four neighbouring nodes and the one above them.
layout(local_size_x = 8, local_size_y = 4) in;
layout(binding = k_first_shadowed_unit) uniform usamplerBuffer first_shadowed;  // four light rays a texel
layout(binding = k_grid_unit) uniform usamplerBuffer nodes_below;
layout(std430, binding = k_grid_storage) writeonly buffer Nodes { uvec4 nodes[]; };
layout(location = 0) uniform uint level;

const uint k_lit = 0xffffu;   // more than any cell
const uint k_none = 0xffffu;  // of a child that is not there: straddled by no ray

// What a node's children hold together.
uint united(uvec4 node) {
  uvec4 low = node & 0xffffu;
  uvec4 high = node >> 16;
  uint least = min(min(low.x, low.y), min(low.z, low.w));
  uint largest = max(max(high.x, high.y), max(high.z, high.w));
  return least | largest << 16;
}

void main() {
  uint parent = gl_GlobalInvocationID.x;
  uint plane = gl_GlobalInvocationID.y;
  uint levels = tree_levels(k_phi_count);
  uint count = nodes_of_level(k_phi_count, level);
  uint first_node = 4u * parent;
  if (first_node >= count || plane >= k_theta_count) return;
  uint root = plane * nodes_per_plane(k_phi_count);
  uint start = root + level_start(levels - 1u - level);
  uvec4 above = uvec4(k_none);
  if (level == 0u) {
    int at = int(plane * (k_phi_count / 4u) + first_node);
    uint last = parent == 0u ? k_lit : texelFetch(first_shadowed, at - 1).w;
    for (uint i = 0u; i < 4u; ++i) {
      uvec4 first = texelFetch(first_shadowed, at + int(i));
      uvec4 before = uvec4(last, first.xyz);
      uvec4 node = min(first, before) | max(first, before) << 16;
      nodes[start + first_node + i] = node;
      above[i] = united(node);
      last = first.w;
    }
  } else {
    uint below = root + level_start(levels - level);
    uint count_below = nodes_of_level(k_phi_count, level - 1u);
    for (uint i = 0u; i < 4u; ++i) {
      uint n = first_node + i;
      uvec4 node = uvec4(k_none);
      for (uint child = 0u; child < 4u; ++child)
        if (4u * n + child < count_below) node[child] = united(texelFetch(nodes_below, int(below + 4u * n + child)));
      if (n < count) {
        nodes[start + n] = node;
        above[i] = united(node);
      }
    }
  }
  if (level + 1u < levels) nodes[root + level_start(levels - 2u - level) + parent] = above;
}
