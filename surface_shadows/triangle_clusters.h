#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/parallel.h"
#include "scene/scene.h"
#include "surface_shadows/cluster_bounds.h"

namespace airlight::surface_shadows {

/// Triangles that neighbour each other, and what bounds them: as the GPU has it (metric_tree.glsl).
struct TriangleCluster {
  ClusterBounds bounds;
  std::uint32_t first;           ///< in TriangleClusters::triangles
  std::uint32_t count_and_part;  ///< how many, below k_part_unit, + k_part_unit · part
};
static_assert(sizeof(TriangleCluster) == 64);

inline constexpr std::uint32_t k_part_unit = 1024;

struct TriangleClusters {
  std::vector<TriangleCluster> clusters;
  std::vector<std::uint32_t> triangles;  ///< each once
};

struct ClusterSettings {
  std::uint32_t most_triangles = 16;  ///< of a cluster; below k_part_unit
  bool has_capsules = true;           ///< else spheres alone
};

/// Groups triangles into clusters: chunks of 512 along a space-filling curve, each cut by hierarchical
/// k-means. The same whatever the number of cores, all of which work on it.
/// @param order triangles of the geometry, neighbours near each other (frame::Clusters::order); the result
/// speaks of their places in it
/// @param part_of_triangle of each place in `order`: no cluster has triangles of two parts. None for one part
/// of all, 0.
/// @param object_of_triangle of each place in `order`: no cluster has triangles of two objects. None for one
/// of all.
/// Based on: the same, section 4; Meister, Bittner, "Parallel BVH construction using k-means clustering",
/// The Visual Computer 32, 2016.
TriangleClusters make_triangle_clusters(const scene::Geometry& geometry, std::span<const std::uint32_t> order,
                                        std::span<const std::uint32_t> part_of_triangle,
                                        const ClusterSettings& settings,
                                        std::span<const std::uint32_t> object_of_triangle = {},
                                        const scene::Progress& progress = {});

}  // namespace airlight::surface_shadows
