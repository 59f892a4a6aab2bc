// The ternary object partitioning tree: four nodes a triangle, which hold the planes that bound its shadow. Nodes 4 t, 4 t + 1 and
// 4 t + 2 hold the planes through the light and an edge of triangle t, node 4 t + 3 its own. A triangle inserted later lies wholly on
// the outside of a plane, wholly inside, or is intersected by it, and goes to that child.
//
// Planes are rounded, and only prune: a node knows how far its plane may be off, what lies within that of it counts as on
// both sides, and frame/occlusion.glsl decides. So the addresses follow from the triangles' numbers, nothing is allocated, and a tree
// of n triangles takes 136 n + 16 bytes.
//
// Based on: Gerhards, Mora, Aveneau, Ghazanfarpour, "Partitioned Shadow Volumes", Eurographics 2015, sections 3.2 to 3.6. What differs:
//  - "Outside" and "inside" are certain; the paper takes the sign of a rounded product.
//  - The wedge of what a plane intersects is bounded by the largest height of its corners over the plane, divided by the distance of
//    the light to the triangle. The largest angle of its corners, which the paper takes, is less than that of some points
//    between them: of n = z and the corners (1, 0, 0.1) and (0, 1, 0.1) the sines are 0.0995, half-way between them 0.140.
//  - What lies wholly farther from the light than the point is not visited.
//  - A point in the shadow of an edge's neighbour goes there by the corners that they share: one that is, bit for bit, an end of the
//    plane's edge fits either side.
// GLSL only.
#include "surface_shadows/depths.glsl"

// planes[4 t + k]: normal, of unit length, towards the outside, of the last towards the light; and offset.
// links[4 t + k + 1]: triangles + 1 to go on with, 0 for none. x: outside; y: intersected; of an edge's plane z: bits of its wedge, w: bits
// of its slack (the inside goes on with the next node); of the last z: bits of its slack, w: the inside, behind the triangle.
// links[0].x: the root.
// subtrees[2 t]: the word of a link that leads to t. subtrees[2 t + 1]: the least depth (`ordered`) of t and of all that was inserted
// below it: what lies higher in the light needs none of them.
const uint k_outside = 0u;
const uint k_intersected = 1u;
const uint k_wedge = 2u;
const uint k_slack_of_edge = 3u;
const uint k_slack_of_last = 2u;
const uint k_inside_of_last = 3u;

// No node.
const uint k_none = 0xffffffffu;

// Where a link leads.
uint first_node_of(uint triangle_plus_one) { return triangle_plus_one == 0u ? k_none : 4u * (triangle_plus_one - 1u); }

// Of what rounding leaves of a sum of three products and an offset, of its terms' size: 5 · 2⁻²³.
const float k_height_error = 6e-7;

// Height of a point above a plane.
float height_above(vec4 plane, vec3 point) {
  precise float height = plane.x * point.x + plane.y * point.y + plane.z * point.z + plane.w;
  return height;
}

// How far a plane reaches from the light's rays: planes through a lamp hold the origin, and their slack grows from there.
float slack_at(uint node, float slack, float distance, float scene_reach, bool is_sun) {
  return slack * (distance + ((node & 3u) == 3u || is_sun ? scene_reach : 0.0));
}
