// Where visibility changes along a view ray, from the first shadowed cells of a half-plane's light rays (epipolar/change_tree.h).
//
// Light ray k is lit at α_i where its first shadowed cell h_k > i. Going out along the view ray, visibility changes before cell k
// where min(h_{k−1}, h_k) ≤ i < max(h_{k−1}, h_k); what lies before the first cell counts as lit. A node of level 0 has four
// neighbouring light rays for children, one of level L four nodes of level L − 1. It is a uvec4, a component a child: the least
// and, in the high half, the largest h of the child's light rays and of the one before them. A view ray that straddles a child,
// min ≤ i < max, sees a change within it.
// The nodes of a plane lie from the root down, each level in order of φ.
#ifndef AIRLIGHT_CHANGE_TREE_GLSL
#define AIRLIGHT_CHANGE_TREE_GLSL
#include "shared.glsl"

// Levels over N_φ light rays, 8 at most; the topmost has one node.
FUNCTION uint tree_levels(uint phi_count) {
  uint levels = 1u;
  while (1u << 2u * levels < phi_count) ++levels;
  return levels;
}

FUNCTION uint nodes_of_level(uint phi_count, uint level) { return (phi_count + (4u << 2u * level) - 1u) >> (2u * level + 2u); }

// Where a level begins in its plane, by how many levels there are above it: 1 + 4 + 16 + … nodes.
FUNCTION uint level_start(uint above) { return 0x55555555u & ((1u << 2u * above) - 1u); }

FUNCTION uint nodes_per_plane(uint phi_count) { return level_start(tree_levels(phi_count) - 1u) + nodes_of_level(phi_count, 0u); }

#endif
