// Goes down the tree with a point, to all nodes whose clusters may hide it, until nothing of the light is left.
// GLSL only; after frame/uniforms.glsl.
#include "surface_shadows/turned_triangle.glsl"
#include "surface_shadows/metric_tree.glsl"
#include "surface_shadows/transmission.glsl"

layout(binding = k_triangle_planes_unit) uniform usamplerBuffer triangle_planes;  // in which plane of the scene each lies
layout(binding = k_clusters_unit) uniform usamplerBuffer clusters;
layout(binding = k_cluster_triangles_unit) uniform usamplerBuffer cluster_triangles;
layout(binding = k_always_asked_unit) uniform usamplerBuffer always_asked;
layout(binding = k_metric_tree_unit) uniform usamplerBuffer nodes;  // four texels each
layout(binding = k_partition_distances_unit) uniform samplerBuffer partition_distances;  // of each node, where they are stored
layout(location = 1) uniform float scale;  // of positions
layout(location = 2) uniform vec3 origin_high;
layout(location = 3) uniform vec3 origin_low;
layout(location = 4) uniform float distance_error;
layout(location = 5) uniform float slack;
layout(location = 6) uniform float root_distance;
layout(location = 7) uniform float scene_reach;  // from the light, of a sun from the eye; scaled

layout(constant_id = 31) const bool k_culls_by_distance = true;
layout(constant_id = 32) const uint k_stack = 32;
layout(constant_id = 33) const bool k_culls_by_interval = true;
layout(constant_id = 35) const bool k_culls_by_slabs = true;
layout(constant_id = 36) const bool k_stores_distances = false;

Occluder occluder(uint triangle) {
  return turned_triangle(light_rays(), LightFrame(origin_high, origin_low, scale), triangle).occluder;
}

uint plane_of(uint triangle) { return texelFetch(triangle_planes, int(triangle)).r; }

// What is asked of the tree.
struct Query {
  LightFrame frame;
  Observer observer;
  float slack;
  float root_distance;
  vec3 point;
  vec3 place;  // where the light sees it
  vec3 to_light;
  uint own_plane;
  uint depth;  // as `ordered`, rounded up
};

float visited_nodes = 0.0;
float asked_clusters = 0.0;
float asked_triangles = 0.0;

// Asks the predicate of the triangles of a node's cluster, until nothing is left of the light.
void ask_cluster(Query query, uint node, bool leaves_out_fronts) {
  int at = 4 * int(node - 1u);
  MetricCluster cluster = cluster_of(texelFetch(clusters, at), texelFetch(clusters, at + 1), texelFetch(clusters, at + 2),
                                     texelFetch(clusters, at + 3));
  bool may_hide = true;
  if (k_culls_by_slabs) {
    Capsule capsule = Capsule(in_light_frame(query.frame, cluster.capsule.from), in_light_frame(query.frame, cluster.capsule.to),
                              query.frame.scale * cluster.capsule.radius);
    may_hide = passes_slabs(capsule, cluster.axis, query.frame.scale * cluster.lower, query.frame.scale * cluster.upper, query.point,
                            query.to_light);
  }
  if (may_hide) {
    asked_clusters += 1.0;
    for (uint i = 0u; i < cluster.count && !is_hidden; ++i) {
      asked_triangles += 1.0;
      uint number = texelFetch(cluster_triangles, int(cluster.first + i)).x;
      TurnedTriangle triangle = turned_triangle(query.observer.rays, query.frame, number);
      if (triangle.turn > 0.0 || (triangle.turn < 0.0 && !leaves_out_fronts))
        meet(query.observer.rays, triangle.occluder, number, query.point, plane_of(number) == query.own_plane);
    }
  }
}

// The two children of a node whose clusters may hide the point, 0 for none: what is near its pivot or else what is beyond, and what
// is both.
struct Children {
  uint child;
  bool is_near;
  uint overlap;
};

// Visits a node. @param asks whether its own cluster is asked, where it may hide the point
Children children_of(Query query, uint node, uint near_steps, bool asks) {
  visited_nodes += 1.0;
  int at = 4 * int(node);
  uvec4 to = texelFetch(nodes, at + 1);
  Children children = Children(0u, false, 0u);
  bool is_beyond = false;
  if (k_culls_by_distance) is_beyond = to.w > query.depth;
  if (!is_beyond) {
    uvec4 from = texelFetch(nodes, at);
    uvec4 links = texelFetch(nodes, at + 2);
    uvec4 rest = texelFetch(nodes, at + 3);
    float distance = distance_to_arc(query.observer, uintBitsToFloat(from.xyz), uintBitsToFloat(to.xyz), query.place);
    float limit = partition_distance(query.root_distance, near_steps);
    if (k_stores_distances) limit = texelFetch(partition_distances, int(node)).x;
    children.is_near = distance <= limit;
    children.child = children.is_near ? links[k_near] : links[k_far];
    children.overlap = links[k_overlap];
    if (k_culls_by_interval) {
      if (distance < uintBitsToFloat(rest.x) - query.slack || distance > uintBitsToFloat(rest.y) + query.slack) children.overlap = 0u;
    }
    if (asks && distance <= uintBitsToFloat(from.w) + query.slack) {
      bool is_before = false;
      if (k_culls_by_distance) is_before = rest.z > query.depth;
      if (!is_before) ask_cluster(query, node, rest.w != 0u);
    }
  }
  return children;
}

// A node that is left for later, and how many steps to what is near led there: δ is halved about twenty times at most before
// nothing is near any more. (Where it is stored there may be more, and no one asks.)
const uint k_node_bits = 26u;

// Visits all nodes that may hide the point, until nothing is left of the light. False where the stack did not hold what was
// left: then some were not.
bool walk_with_stack(Query query, uint root) {
  uint stack[k_stack];
  uint height = 0u;
  bool has_overflowed = false;
  uint node = root;
  uint near_steps = 0u;
  while (node != 0u) {
    Children children = children_of(query, node, near_steps, true);
    if (children.child != 0u) {
      if (children.overlap != 0u) {
        if (height < k_stack) {
          stack[height++] = children.overlap | near_steps << k_node_bits;
        } else {
          has_overflowed = true;
        }
      }
      node = children.child;
      if (children.is_near) ++near_steps;
    } else if (children.overlap != 0u) {
      node = children.overlap;
    } else if (height > 0u) {
      uint next = stack[--height];
      node = next & ((1u << k_node_bits) - 1u);
      near_steps = next >> k_node_bits;
    } else {
      node = 0u;
    }
    if (is_hidden) node = 0u;
  }
  return !has_overflowed;
}

// The same, with the way back in the tree: each node is decided anew there.
void walk_without_stack(Query query, uint root) {
  uint node = root;
  uint near_steps = 0u;
  bool is_back_from_child = false;    // of what is near or beyond
  bool is_back_from_overlap = false;  // the last child
  while (node != 0u) {
    uint next = 0u;
    if (!is_back_from_overlap) {
      Children children = children_of(query, node, near_steps, !is_back_from_child);
      bool goes_to_child = !is_back_from_child && children.child != 0u;
      next = goes_to_child ? children.child : children.overlap;
      if (goes_to_child && children.is_near) ++near_steps;
    }
    if (is_hidden) {
      node = 0u;
    } else if (next != 0u) {
      node = next;
      is_back_from_child = false;
      is_back_from_overlap = false;
    } else {
      uint place = texelFetch(nodes, 4 * int(node) + 2).w;
      uint child = place & 3u;
      node = place >> 2;
      is_back_from_overlap = child == k_overlap;
      is_back_from_child = !is_back_from_overlap;
      if (node != 0u && child == k_near) --near_steps;
    }
  }
}

// What is left of the light at a point, scaled and relative to the light, under a sun to the eye.
// `own_plane`: of the point's surface (occluders.glsl); k_in_air for none.
vec3 light_at(vec3 point, uint own_plane) {
  begin_point();
  Query query;
  query.frame = LightFrame(origin_high, origin_low, scale);
  query.observer = Observer(light_rays(), distance_error);
  query.slack = slack;
  query.root_distance = root_distance;
  query.point = point;
  query.place = place_of(query.observer, query.point);
  query.own_plane = own_plane;
  float reach = scene_reach;
  if (query.observer.rays.is_sun) {
    query.to_light = -2.0 * reach * query.observer.rays.travels;
    query.depth = ordered(ordered_dot(query.observer.rays.travels, query.point) + k_depth_error * reach);
  } else {
    query.to_light = -query.point;
    query.depth = ordered(length(query.point) * (1.0 + k_depth_error));
  }

  uint always_count = texelFetch(nodes, 2).w;
  for (uint i = 0u; i < always_count && !is_hidden; ++i) {
    uint node = texelFetch(always_asked, int(i)).x;
    ask_cluster(query, node, texelFetch(nodes, 4 * int(node) + 3).w != 0u);
  }
  uint root = texelFetch(nodes, 2).x;
  bool is_complete = is_hidden;
  uvec3 taken_before = taken;
  if (!is_complete) is_complete = walk_with_stack(query, root);
  if (!is_complete && !is_hidden) {
    taken = taken_before;
    walk_without_stack(query, root);
  }
  return light_left();
}
