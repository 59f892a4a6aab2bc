#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/occluders.glsl"
#include "surface_shadows/top_tree.glsl"

// Goes down the tree with the point that the pixel shades, to all children whose triangles may hide it (Algorithm 2), until one does.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_surface_unit) uniform sampler2D surface_points;
layout(binding = k_tree_planes_unit) uniform samplerBuffer planes;
layout(binding = k_tree_links_unit) uniform usamplerBuffer links;
layout(binding = k_subtrees_unit) uniform usamplerBuffer subtrees;
layout(location = 0) uniform float scale;        // of positions
layout(location = 1) uniform float scene_reach;  // from the light, of a sun from the eye; scaled
layout(location = 0) out float visibility;

layout(constant_id = 0) const bool k_counts = false;  // writes how many nodes were visited instead
layout(constant_id = 1) const bool k_uses_wedge = true;
layout(constant_id = 2) const uint k_stack = 32;
layout(constant_id = 3) const bool k_is_stackless = false;

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
bool is_hidden = false;

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
      if (asks) is_hidden = hides_surface(query.rays, node >> 2, query.point, query.own_plane);
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

// Visits all nodes that may hide the point, until one does. False where the stack did not hold what was left: then some were not.
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


void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 point_and_facing = texelFetch(surface_points, pixel, 0);
  visibility = 0.0;
  if (point_and_facing.w <= 0.0) return;
  vec3 point = scale * point_and_facing.xyz;
  float distance = length(point);
  Query query = Query(light_rays(), point, distance, k_height_error * (distance + scene_reach),
                      plane_of(texelFetch(triangle_plus_one, pixel, 0).r - 1u), 0u);
  float depth = query.rays.is_sun ? ordered_dot(query.rays.travels, point) : distance;
  query.depth = ordered(depth + k_depth_error * (query.rays.is_sun ? scene_reach : distance));
  uint root = first_node_of(texelFetch(links, 0).x);
  bool is_complete = false;
  if (!k_is_stackless) is_complete = walk_with_stack(query, root);
  if (!is_complete && !is_hidden) walk_without_stack(query, root);
  if (k_counts) {
    visibility = visited;
  } else {
    visibility = is_hidden ? 0.0 : 1.0;
  }
}
