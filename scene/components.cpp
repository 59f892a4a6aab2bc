#include "scene/components.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace airlight::scene {
namespace {

/// The number of each position among the different ones.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
  const auto key = [&](std::uint32_t i) {
    return std::tuple(positions[i].x, positions[i].y, positions[i].z);
  };
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> welded(positions.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && key(order[i]) != key(order[i - 1])) ++count;
    welded[order[i]] = count;
  }
  return welded;
}

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

Components find_components(const Geometry& geometry) {
  struct Edge {
    std::uint32_t lower, upper, triangle;
    auto ends() const { return std::pair(lower, upper); }
  };
  const std::vector<std::uint32_t> welded = weld(geometry.positions);
  std::vector<Edge> edges;
  std::vector<std::array<std::uint32_t, 3>> faces;
  edges.reserve(3 * geometry.triangles.size());
  faces.reserve(geometry.triangles.size());
  for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
    const glm::uvec3 triangle = geometry.triangles[t];
    std::array<std::uint32_t, 3> face = {welded[triangle.x], welded[triangle.y], welded[triangle.z]};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [lower, upper] = std::minmax(face[i], face[(i + 1) % 3]);
      edges.push_back({lower, upper, t});
    }
    std::sort(face.begin(), face.end());
    faces.push_back(face);
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends() < b.ends(); });

  // Join what shares an edge; note the edges that no solid has.
  Components result;
  Sets sets(geometry.triangles.size());
  std::vector<std::uint32_t> at_gap;
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end].ends() == edges[first].ends()) {
      sets.join(edges[end].triangle, edges[first].triangle);
      ++end;
    }
    if ((end - first) % 2 == 0) continue;
    ++(end - first == 1 ? result.open_edges : result.odd_edges);
    at_gap.push_back(edges[first].triangle);
  }

  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 1; i < faces.size(); ++i)
    result.duplicate_triangles += faces[i] == faces[i - 1] ? 1 : 0;

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
