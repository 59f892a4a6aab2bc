#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace airlight::surface_shadows {

/// A node of a metric tree as the GPU has it: MetricNode of shaders/surface_shadows/metric_tree.glsl.
struct MetricNode {
  glm::vec3 from;
  float width;  ///< below 0 of a cluster that is not in the tree
  glm::vec3 to;
  std::uint32_t least_depth;
  std::array<std::uint32_t, 3> children;
  std::uint32_t place;
  float overlap_least, overlap_most;
  std::uint32_t depth;
  std::uint32_t leaves_out_fronts;
};
static_assert(sizeof(MetricNode) == 64);

/// Who looks at the clusters: see Observer of shaders/surface_shadows/apparent.glsl.
struct MedianTreeView {
  glm::vec3 travels;  ///< unit direction of a sun's light
  bool is_sun;
  float error;  ///< of a distance
  float slack;  ///< what a decision keeps clear of its limit
};

/// Links the nodes to the tree that the paper measures its own by, on the CPU: the pivot of a set is the one
/// of a few whose distances to a few others are spread the most, δ the median of its distances to the others.
/// As in the tree of the GPU what is near, beyond, or both, becomes a child.
/// @param nodes as shaders/surface_shadows/metric_tree_cones.comp leaves them; node 0 stands before the root
/// @param seed of the choices
/// @returns δ of each node
/// Based on: Deves, Mora, Aveneau, Ghazanfarpour, "Scalable Real-Time Shadows using Clustering and Metric
/// Trees", EGSR 2018, section 6, "Metric tree quality"; Yianilos, "Data Structures and Algorithms for Nearest
/// Neighbor Search in General Metric Spaces", SODA 1993, section 3, for the pivots; Uhlmann, "Satisfying
/// General Proximity / Similarity Queries with Metric Trees", 1991, for the median. The distance of two is
/// here the mean of the least and the greatest from the pivot's arc.
std::vector<float> link_median_tree(std::span<MetricNode> nodes, const MedianTreeView& view,
                                    std::uint32_t seed);

}  // namespace airlight::surface_shadows
