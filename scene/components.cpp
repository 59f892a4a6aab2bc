#include "scene/components.h"

#include <algorithm>
#include <array>
#include <numeric>

#include <fmt/format.h>

namespace airlight::scene {
namespace {

/// Disjoint sets of triangles.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// How much more often the triangles of an edge go along it from its lower to its upper end than back.
int imbalance(const Geometry& geometry, const Edges& edges, const Edges::Edge& edge) {
  if (edge.lower == edge.upper) return 0;
  int result = 0;
  const auto triangles = edges.triangles_of(edge);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i > 0 && triangles[i] == triangles[i - 1]) continue;  // a triangle that goes along it twice
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t from = edges.position_of_vertex[geometry.triangles[triangles[i]][side]],
                          to = edges.position_of_vertex[geometry.triangles[triangles[i]][(side + 1) % 3]];
      if (from == edge.lower && to == edge.upper) ++result;
      if (from == edge.upper && to == edge.lower) --result;
    }
  }
  return result;
}

}  // namespace

Components find_components(const Geometry& geometry, const Edges& edges) {
  // Join what shares an edge; note the edges that no solid has.
  Components result;
  Sets sets(geometry.triangles.size());
  std::vector<std::uint32_t> at_gap, at_turn;
  for (const Edges::Edge& edge : edges.edges) {
    const auto triangles = edges.triangles_of(edge);
    for (const std::uint32_t triangle : triangles) sets.join(triangle, triangles[0]);
    if (imbalance(geometry, edges, edge) != 0) at_turn.push_back(triangles[0]);
    if (edge.count % 2 == 0) continue;
    ++(edge.count == 1 ? result.open_edges : result.odd_edges);
    at_gap.push_back(triangles[0]);
  }

  // Count the triangles that have another one's corners.
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(geometry.triangles.size());
  for (const glm::uvec3& triangle : geometry.triangles) {
    std::array<std::uint32_t, 3> face;
    for (int i = 0; i < 3; ++i) face[static_cast<std::size_t>(i)] = edges.position_of_vertex[triangle[i]];
    std::sort(face.begin(), face.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 1; i < faces.size(); ++i)
    result.duplicate_triangles += faces[i] == faces[i - 1] ? 1 : 0;

  // Number the components.
  constexpr std::uint32_t k_none = ~0u;
  std::vector<std::uint32_t> number_of_root(geometry.triangles.size(), k_none);
  for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
    std::uint32_t& number = number_of_root[sets.find(t)];
    if (number == k_none) number = static_cast<std::uint32_t>(result.count++);
    result.of_triangle.push_back(number);
  }
  result.has_two_sides.assign(result.count, true);
  for (const std::uint32_t triangle : at_turn) result.has_two_sides[result.of_triangle[triangle]] = false;
  std::vector<bool> is_open(result.count, false);
  for (const std::uint32_t triangle : at_gap) is_open[result.of_triangle[triangle]] = true;
  result.open_components = static_cast<std::size_t>(std::count(is_open.begin(), is_open.end(), true));
  return result;
}

std::vector<Box> boxes_of(const Components& components, const Geometry& geometry) {
  std::vector<Box> boxes(components.count);
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
    const glm::uvec3 triangle = geometry.triangles[t];
    for (const glm::uint corner : {triangle.x, triangle.y, triangle.z})
      boxes[components.of_triangle[t]].include(geometry.positions[corner]);
  }
  return boxes;
}

std::string describe_gaps(const Components& components) {
  return fmt::format(
      "{} of {} connected parts are open: {} edges with one triangle, {} with another odd number; {} "
      "triangles are "
      "there twice, and cancel",
      components.open_components, components.count, components.open_edges, components.odd_edges,
      components.duplicate_triangles);
}

}  // namespace airlight::scene
