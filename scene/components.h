#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/edges.h"
#include "scene/scene.h"

namespace airlight::scene {

/// The connected components of a mesh, and what keeps them from being the boundary of a solid.
///
/// Corners at the same position are one corner, and triangles that share an edge are connected. A component
/// bounds a solid where each of its edges has an even number of triangles.
struct Components {
  std::vector<std::uint32_t> of_triangle;  ///< component of each triangle, from 0
  std::size_t count = 0;
  /// Of each component, whether its triangles go round each of its edges as often one way as the other: what
  /// crosses it from outside to outside then does so as often from their fronts as from their backs.
  std::vector<bool> has_two_sides;
  std::size_t open_edges = 0;           ///< with one triangle
  std::size_t odd_edges = 0;            ///< with 3, 5, … triangles
  std::size_t duplicate_triangles = 0;  ///< that have the corners of another one: two of them cancel
  std::size_t open_components = 0;      ///< with an open or odd edge

  bool is_watertight() const { return open_edges == 0 && odd_edges == 0 && duplicate_triangles == 0; }
};

/// @param edges of the same geometry
Components find_components(const Geometry& geometry, const Edges& edges);

/// What each component fills.
std::vector<Box> boxes_of(const Components& components, const Geometry& geometry);

/// One line with the counts, for a mesh that is not watertight.
std::string describe_gaps(const Components& components);

}  // namespace airlight::scene
