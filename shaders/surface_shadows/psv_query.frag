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
// The count of triangles, and bits of the scale of positions and of how far the scene reaches. One uniform, so that it is in use where
// a part of it is.
layout(location = 0) uniform uvec3 scene_of_tree;
layout(location = 0) out float visibility;

layout(constant_id = 0) const bool k_counts = false;  // writes how many nodes were visited instead
layout(constant_id = 1) const bool k_uses_wedge = true;
layout(constant_id = 2) const uint k_stack = 32;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 point_and_facing = texelFetch(surface_points, pixel, 0);
  visibility = 0.0;
  if (point_and_facing.w <= 0.0) return;
  LightRays rays = light_rays();
  uint own_plane = plane_of(texelFetch(triangle_plus_one, pixel, 0).r - 1u);
  float scene_reach = uintBitsToFloat(scene_of_tree.z);
  vec3 point = uintBitsToFloat(scene_of_tree.y) * point_and_facing.xyz;
  float distance = length(point);
  float height_error = k_height_error * (distance + scene_reach);

  uint stack[k_stack];  // nodes that are left
  uint height_of_stack = 0u;
  bool has_overflowed = false;
  bool is_hidden = false;
  float visited = 0.0;
  uint node = first_node_of(texelFetch(links, 0).x);
  while (node != k_none) {
    visited += 1.0;
    bool is_last = (node & 3u) == 3u;
    vec4 plane = texelFetch(planes, int(node));
    uvec4 link = texelFetch(links, int(node + 1u));
    float height = height_above(plane, point);
    float slack = slack_at(node, uintBitsToFloat(is_last ? link[k_slack_of_last] : link[k_slack_of_edge]), distance, scene_reach,
                           rays.is_sun);
    bool may_be_outside = height >= -slack;
    bool may_be_inside = height <= slack;
    bool may_be_intersected = true;
    if (is_last) {
      // What is certainly before the triangle asks nothing. Of a point that the triangle does not hide where its shadow is, its own
      // surface or one beside it, nothing is known.
      if (may_be_inside) {
        is_hidden = hides_surface(rays, node >> 2, point, own_plane);
        may_be_outside = true;
      }
    } else if (k_uses_wedge) {
      float wedge = uintBitsToFloat(link[k_wedge]);
      may_be_intersected = abs(height) <= (rays.is_sun ? wedge : wedge * distance) * 1.00001 + height_error;
    }
    // The children that follow, the last of them at once, the others later.
    uint inside = !may_be_inside ? k_none : is_last ? first_node_of(link[k_inside_of_last]) : node + 1u;
    uint outside = may_be_outside ? first_node_of(link[k_outside]) : k_none;
    uint intersected = may_be_intersected ? first_node_of(link[k_intersected]) : k_none;
    node = inside;
    for (uint i = 0u; i < 2u; ++i) {
      uint child = i == 0u ? outside : intersected;
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
  // Some nodes were not visited: ask all triangles.
  if (has_overflowed && !is_hidden) is_hidden = any_hides_surface(rays, scene_of_tree.x, point, own_plane);
  if (k_counts) {
    visibility = visited;
  } else {
    visibility = is_hidden ? 0.0 : 1.0;
  }
}
