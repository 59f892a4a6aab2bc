#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "surface_shadows/light_frame.glsl"
#include "surface_shadows/metric_tree.glsl"

// Writes the nodes of a metric tree, without children: what the light sees of each cluster's capsule, one an invocation. In a
// dispatch of its own, so that whoever is led to a node while the tree grows finds it written. A cluster gets no place in the tree
// where none of its triangles can hide what is seen, and where the light is in its capsule, or nearly: then it is always asked.
layout(local_size_x = 64) in;
layout(binding = k_clusters_unit) uniform usamplerBuffer clusters;
layout(binding = k_is_culled_unit) uniform usamplerBuffer is_culled;  // whether those of a part that face the light are left out
layout(std430, binding = k_metric_tree_storage) buffer Nodes { MetricNode nodes[]; };
layout(std430, binding = k_always_asked_storage) writeonly buffer AlwaysAsked { uint always_asked[]; };  // nodes
// Half-spaces that hold the eye's view and the light, and all between them: inward normal, and offset.
layout(std430, binding = k_light_view_storage) readonly buffer LightView { vec4 half_spaces[]; };
layout(location = 0) uniform vec3 origin_high;
layout(location = 1) uniform vec3 origin_low;
layout(location = 2) uniform float scale;
layout(location = 3) uniform uint cluster_count;
layout(location = 4) uniform uint half_space_count;

layout(constant_id = 0) const bool k_culls = false;
layout(constant_id = 1) const bool k_uses_normal_cones = true;

// Whether all of a capsule lies outside of what the light has to look at.
bool is_out_of_view(Capsule capsule) {
  bool is_out = false;
  for (uint i = 0u; i < half_space_count && !is_out; ++i) {
    vec4 half_space = half_spaces[i];
    float highest = max(dot(half_space.xyz, capsule.from), dot(half_space.xyz, capsule.to)) + capsule.radius;
    is_out = highest + half_space.w < 0.0;
  }
  return is_out;
}

void main() {
  uint number = gl_GlobalInvocationID.x;
  if (number >= cluster_count) return;
  int at = 4 * int(number);
  MetricCluster cluster = cluster_of(texelFetch(clusters, at), texelFetch(clusters, at + 1), texelFetch(clusters, at + 2),
                                     texelFetch(clusters, at + 3));
  Observer observer = Observer(light_rays(), 0.0);
  LightFrame frame = LightFrame(origin_high, origin_low, scale);
  Capsule capsule = Capsule(in_light_frame(frame, cluster.capsule.from), in_light_frame(frame, cluster.capsule.to),
                            scale * cluster.capsule.radius);
  SeenCapsule seen = seen_capsule(observer, capsule);

  bool leaves_out_fronts = false;
  bool hides_nothing = is_out_of_view(capsule);
  if (k_culls) {
    leaves_out_fronts = texelFetch(is_culled, int(cluster.part)).x != 0u;
    if (k_uses_normal_cones) {
      if (leaves_out_fronts)
        hides_nothing =
            hides_nothing || shows_fronts(observer, capsule, seen, cluster.axis, cluster.opening, scale * cluster.least_altitude);
    }
  }

  uint node = number + 1u;
  if (seen.is_all && !hides_nothing) always_asked[atomicAdd(nodes[0].place, 1u)] = node;
  nodes[node].from = seen.apparent.from;
  nodes[node].width = seen.is_all || hides_nothing ? k_no_place : seen.apparent.width;
  nodes[node].to = seen.apparent.to;
  nodes[node].least_depth = ordered(seen.depth);
  nodes[node].children[k_near] = 0u;
  nodes[node].children[k_far] = 0u;
  nodes[node].children[k_overlap] = 0u;
  nodes[node].place = 0u;
  nodes[node].overlap_least = 0x7f800000u;
  nodes[node].overlap_most = 0u;
  nodes[node].depth = ordered(seen.depth);
  nodes[node].leaves_out_fronts = leaves_out_fronts ? 1u : 0u;
}
