#include "scene/edges.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

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

}  // namespace

Edges find_edges(const Geometry& geometry) {
  Edges result;
  result.position_of_vertex = weld(geometry.positions);

  struct Side {
    std::uint32_t lower, upper, triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * geometry.triangles.size());
  for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [lower, upper] = std::minmax(result.position_of_vertex[geometry.triangles[t][i]],
                                              result.position_of_vertex[geometry.triangles[t][(i + 1) % 3]]);
      sides.push_back({lower, upper, t});
    }
  }
  std::sort(sides.begin(), sides.end());

  result.triangles.reserve(sides.size());
  for (const Side& side : sides) {
    if (result.edges.empty() || result.edges.back().lower != side.lower ||
        result.edges.back().upper != side.upper)
      result.edges.push_back(
          {side.lower, side.upper, static_cast<std::uint32_t>(result.triangles.size()), 0});
    ++result.edges.back().count;
    result.triangles.push_back(side.triangle);
  }
  return result;
}

}  // namespace airlight::scene
