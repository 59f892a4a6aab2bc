// Goes down the tree with a point, to all children whose triangles may hide it (Algorithm 2), until nothing of the light is left.
// GLSL only; after frame/uniforms.glsl.
#include "surface_shadows/occluders.glsl"
#include "surface_shadows/top_tree.glsl"
#include "surface_shadows/transmission.glsl"

layout(binding = k_tree_planes_unit) uniform samplerBuffer planes;
layout(binding = k_tree_links_unit) uniform usamplerBuffer links;
layout(binding = k_subtrees_unit) uniform usamplerBuffer subtrees;
layout(location = 1) uniform float scale;        // of positions
layout(location = 2) uniform float scene_reach;  // from the light, of a sun from the eye; scaled

layout(constant_id = 31) const bool k_uses_wedge = true;
layout(constant_id = 32) const uint k_stack = 32;
layout(constant_id = 33) const bool k_is_stackless = false;

// What is asked of the tree.
struct Query {
  LightRays rays;
  vec3 point;
  float distance;  // from the light, of a sun from the eye
  float height_error;
  uint own_plane;
  uint depth;    // as `ordered`, rounded up
};

// Of a node, the children whose triangles may hide the point: in the order of visits.
const uint k_inside_child = 0u;
const uint k_outside_child = 1u;
const uint k_intersected_child = 2u;

float visited = 0.0;  // nodes

// Visits a node. @param asks whether the node's triangle is asked, where the point may be in its shadow
uvec3 children_of(Query query, uint node, bool asks) {
  visited += 1.0;
  if ((node & 3u) == 0u) {
    // All of the subtree lies beyond the point.
    if (texelFetch(subtrees, 2 * int(node >> 2) + 1).x > query.depth) return uvec3(k_none);
  }
  bool is_last = (node & 3u) == 3u;
  vec4 plane = texelFetch(planes, int(node));
  uvec4 link = texelFetch(links, int(node + 1u));
  float height = height_above(plane, query.point);
  float slack = slack_at(node, uintBitsToFloat(is_last ? link[k_slack_of_last] : link[k_slack_of_edge]), query.distance,
                         scene_reach, query.rays.is_sun);
  bool may_be_outside = height >= -slack;
  bool may_be_inside = height <= slack;
  bool may_be_intersected = true;
  if (is_last) {
    // What is certainly before the triangle asks nothing. Of a point that the triangle does not hide where its shadow is, its own
    // surface or one beside it, nothing is known.
    if (may_be_inside) {
      if (asks)
        meet(query.rays, occluder(node >> 2), node >> 2, query.point, plane_of(node >> 2) == query.own_plane);
      may_be_outside = true;
    }
  } else if (k_uses_wedge) {
    float wedge = uintBitsToFloat(link[k_wedge]);
    may_be_intersected =
        abs(height) <= (query.rays.is_sun ? wedge : wedge * query.distance) * 1.00001 + query.height_error;
  }
  return uvec3(!may_be_inside ? k_none : is_last ? first_node_of(link[k_inside_of_last]) : node + 1u,
               may_be_outside ? first_node_of(link[k_outside]) : k_none,
               may_be_intersected ? first_node_of(link[k_intersected]) : k_none);
}

// Visits all nodes that may hide the point, until nothing is left of the light. False where the stack did not hold what was
// left: then some were not.
bool walk_with_stack(Query query, uint root) {
  uint stack[k_stack];  // nodes that are left
  uint height_of_stack = 0u;
  bool has_overflowed = false;
  uint node = root;
  while (node != k_none) {
    uvec3 children = children_of(query, node, true);
    node = children[k_inside_child];
    for (uint i = k_outside_child; i <= k_intersected_child; ++i) {
      uint child = children[i];
      if (child != k_none) {
        if (node == k_none) {
          node = child;
        } else if (height_of_stack < k_stack) {
          stack[height_of_stack++] = child;
        } else {
          has_overflowed = true;
        }
      }
    }
    if (node == k_none && height_of_stack > 0u) node = stack[--height_of_stack];
    if (is_hidden) node = k_none;
  }
  return !has_overflowed;
}

// The same, with the way back in the tree.
void walk_without_stack(Query query, uint root) {
  uint node = root;
  uint next = k_inside_child;  // children before this one have been visited
  while (node != k_none) {
    uvec3 children = children_of(query, node, next == k_inside_child);
    while (next <= k_intersected_child && children[min(next, k_intersected_child)] == k_none) ++next;
    if (is_hidden) {
      node = k_none;
    } else if (next <= k_intersected_child) {
      node = children[next];
      next = k_inside_child;
    } else if ((node & 3u) != 0u) {
      --node;
      next = k_outside_child;
    } else {
      uint place = texelFetch(subtrees, 2 * int(node >> 2)).x;
      node = place == 0u ? k_none : (place >> 2) - 1u;
      uint word = place & 3u;
      bool is_inside = (node & 3u) == 3u && word == k_inside_of_last;
      next = is_inside ? k_outside_child : word == k_outside ? k_intersected_child : k_intersected_child + 1u;
    }
  }
}

// What is left of the light at a point, scaled and relative to the light, under a sun to the eye.
// `own_plane`: of the point's surface (occluders.glsl); k_in_air for none.
vec3 light_at(vec3 point, uint own_plane) {
  begin_point();
  float distance = length(point);
  Query query = Query(light_rays(), point, distance, k_height_error * (distance + scene_reach), own_plane, 0u);
  float depth = query.rays.is_sun ? ordered_dot(query.rays.travels, point) : distance;
  query.depth = ordered(depth + k_depth_error * (query.rays.is_sun ? scene_reach : distance));
  uint root = first_node_of(texelFetch(links, 0).x);
  bool is_complete = false;
  if (!k_is_stackless) is_complete = walk_with_stack(query, root);
  if (!is_complete && !is_hidden) {
    begin_point();
    walk_without_stack(query, root);
  }
  return light_left();
}
