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

}  // namespace

Components find_components(const Geometry& geometry, const Edges& edges) {
  // Join what shares an edge; note the edges that no solid has.
  Components result;
  Sets sets(geometry.triangles.size());
  std::vector<std::uint32_t> at_gap;
  for (const Edges::Edge& edge : edges.edges) {
    const auto triangles = edges.triangles_of(edge);
    for (const std::uint32_t triangle : triangles) sets.join(triangle, triangles[0]);
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
  std::vector<bool> is_open(result.count, false);
  for (const std::uint32_t triangle : at_gap) is_open[result.of_triangle[triangle]] = true;
  result.open_components = static_cast<std::size_t>(std::count(is_open.begin(), is_open.end(), true));
  return result;
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
