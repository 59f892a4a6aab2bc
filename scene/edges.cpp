#include "scene/edges.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include "scene/parallel.h"

namespace airlight::scene {
namespace {

constexpr int k_parts = 256;  ///< that all cores share; of no influence on the result but the ends' numbers

/// Calls `work(part, first, end)` with runs of 0 … count − 1.
void in_parts(std::size_t count, const std::function<void(int, std::size_t, std::size_t)>& work) {
  parallel(k_parts, [&] {
    return [&](int part) {
      const auto border = [&](int i) { return count * static_cast<std::size_t>(i) / k_parts; };
      work(part, border(part), border(part + 1));
    };
  });
}

/// What is alike for positions that are: −0 is 0.
std::uint32_t part_of(glm::vec3 position) {
  std::uint64_t hash = 0;
  for (int i = 0; i < 3; ++i) {
    const float value = position[i] == 0.0f ? 0.0f : position[i];
    hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return static_cast<std::uint32_t>(hash >> 32) % k_parts;
}

/// Where each of `groups` begins, and at last where all end, when things are put in order by their group.
std::vector<std::uint32_t> starts_of(const std::vector<std::uint32_t>& group_of, std::size_t groups) {
  std::vector<std::uint32_t> starts(groups + 1, 0);
  for (const std::uint32_t group : group_of) ++starts[group + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  return starts;
}

/// The things in that order.
std::vector<std::uint32_t> in_order(const std::vector<std::uint32_t>& group_of,
                                    std::vector<std::uint32_t> starts) {
  std::vector<std::uint32_t> order(group_of.size());
  for (std::uint32_t i = 0; i < group_of.size(); ++i) order[starts[group_of[i]]++] = i;
  return order;
}

/// The number of each position among the different ones. @returns how many these are
std::size_t weld(const std::vector<glm::vec3>& positions, std::vector<std::uint32_t>& welded) {
  std::vector<std::uint32_t> part_of_vertex(positions.size());
  in_parts(positions.size(), [&](int, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) part_of_vertex[i] = part_of(positions[i]);
  });
  const std::vector<std::uint32_t> starts = starts_of(part_of_vertex, k_parts);
  std::vector<std::uint32_t> order = in_order(part_of_vertex, starts);

  const auto key = [&](std::uint32_t i) {
    return std::tuple(positions[i].x, positions[i].y, positions[i].z);
  };
  welded.resize(positions.size());
  std::vector<std::uint32_t> first_number(k_parts + 1, 0);
  // As many runs as parts: each is one of those.
  in_parts(k_parts, [&](int, std::size_t part, std::size_t) {
    const auto begin = order.begin() + starts[part], end = order.begin() + starts[part + 1];
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::uint32_t count = 0;
    for (auto at = begin; at != end; ++at) {
      if (at == begin || key(*at) != key(*(at - 1))) ++count;
      welded[*at] = count - 1;
    }
    first_number[part + 1] = count;
  });
  std::partial_sum(first_number.begin(), first_number.end(), first_number.begin());
  in_parts(positions.size(), [&](int, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) welded[i] += first_number[part_of_vertex[i]];
  });
  return first_number.back();
}

/// @param end_of_vertex the number of each vertex's end, of so many
Edges edges_between(const Geometry& geometry, std::vector<std::uint32_t> end_of_vertex, std::size_t ends) {
  struct Side {
    std::uint32_t upper, triangle;
    bool operator<(const Side& other) const {
      return std::tie(upper, triangle) < std::tie(other.upper, other.triangle);
    }
  };
  const std::size_t side_count = 3 * geometry.triangles.size();
  std::vector<std::uint32_t> lower(side_count);
  std::vector<Side> unordered(side_count);
  in_parts(geometry.triangles.size(), [&](int, std::size_t first, std::size_t end) {
    for (std::size_t t = first; t < end; ++t) {
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = end_of_vertex[geometry.triangles[t][i]],
                            b = end_of_vertex[geometry.triangles[t][(i + 1) % 3]];
        const std::size_t side = 3 * t + static_cast<std::size_t>(i);
        lower[side] = std::min(a, b);
        unordered[side] = {std::max(a, b), static_cast<std::uint32_t>(t)};
      }
    }
  });
  const std::vector<std::uint32_t> starts = starts_of(lower, ends);
  const std::vector<std::uint32_t> order = in_order(lower, starts);

  Edges result;
  result.position_of_vertex = std::move(end_of_vertex);
  result.triangles.resize(side_count);
  std::vector<Side> sides(side_count);
  std::vector<std::vector<Edges::Edge>> of_part(k_parts);
  in_parts(ends, [&](int part, std::size_t first, std::size_t end) {
    std::vector<Edges::Edge>& edges = of_part[static_cast<std::size_t>(part)];
    for (std::size_t at_end = first; at_end < end; ++at_end) {
      const std::uint32_t begin = starts[at_end], stop = starts[at_end + 1];
      for (std::uint32_t i = begin; i < stop; ++i) sides[i] = unordered[order[i]];
      std::sort(sides.begin() + begin, sides.begin() + stop);
      for (std::uint32_t i = begin; i < stop; ++i) {
        if (i == begin || sides[i].upper != sides[i - 1].upper)
          edges.push_back({static_cast<std::uint32_t>(at_end), sides[i].upper, i, 0});
        ++edges.back().count;
        result.triangles[i] = sides[i].triangle;
      }
    }
  });
  std::size_t count = 0;
  for (const std::vector<Edges::Edge>& edges : of_part) count += edges.size();
  result.edges.reserve(count);
  for (const std::vector<Edges::Edge>& edges : of_part)
    result.edges.insert(result.edges.end(), edges.begin(), edges.end());
  return result;
}

}  // namespace

Edges find_edges(const Geometry& geometry) {
  std::vector<std::uint32_t> position_of_vertex;
  const std::size_t positions = weld(geometry.positions, position_of_vertex);
  return edges_between(geometry, std::move(position_of_vertex), positions);
}

EdgeCounts count_edges(const Geometry& geometry) {
  std::vector<std::uint32_t> vertices(geometry.positions.size());
  std::iota(vertices.begin(), vertices.end(), 0u);
  EdgeCounts counts;
  counts.by_vertex = edges_between(geometry, std::move(vertices), geometry.positions.size()).edges.size();
  const Edges edges = find_edges(geometry);
  counts.by_position = edges.edges.size();
  for (const Edges::Edge& edge : edges.edges) {
    counts.open += edge.count == 1 ? 1 : 0;
    counts.of_more_than_two += edge.count > 2 ? 1 : 0;
    counts.most_triangles = std::max(counts.most_triangles, std::size_t{edge.count});
  }
  return counts;
}

}  // namespace airlight::scene
