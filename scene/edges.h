#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace airlight::scene {

/// The edges of a mesh, each with all of its triangles. Vertices at the same position are one end, so that a
/// mesh whose vertices are split, as by its normals, has the edges that one sees.
struct Edges {
  struct Edge {
    std::uint32_t lower, upper;  ///< its ends, numbers of positions; lower ≤ upper
    std::uint32_t first, count;  ///< its triangles: a run of `triangles`
  };

  std::vector<std::uint32_t>
      position_of_vertex;   ///< the number of its position, from 0, among all that differ
  std::vector<Edge> edges;  ///< in the order of their ends
  std::vector<std::uint32_t> triangles;

  std::span<const std::uint32_t> triangles_of(const Edge& edge) const {
    return std::span(triangles).subspan(edge.first, edge.count);
  }
};

/// On all cores; the same on any number of them.
Edges find_edges(const Geometry& geometry);

struct EdgeCounts {
  std::size_t by_vertex = 0;         ///< edges whose ends are vertices, as a file has them
  std::size_t by_position = 0;       ///< those of find_edges; of these:
  std::size_t open = 0;              ///< of one triangle
  std::size_t of_more_than_two = 0;  ///< triangles
  std::size_t most_triangles = 0;    ///< of one edge
};

EdgeCounts count_edges(const Geometry& geometry);

}  // namespace airlight::scene
