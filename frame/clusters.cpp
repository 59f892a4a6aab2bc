#include "frame/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace airlight::frame {
namespace {

/// Spreads the low 21 bits so that two zero bits follow each.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

std::array<glm::dvec3, 3> corners(const scene::Geometry& geometry, std::uint32_t triangle) {
  const glm::uvec3 t = geometry.triangles[triangle];
  return {glm::dvec3(geometry.positions[t.x]), glm::dvec3(geometry.positions[t.y]),
          glm::dvec3(geometry.positions[t.z])};
}

double distance_to_segment(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double s = length2 > 0.0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  return glm::length(p - a - s * ab);
}

double distance_to_triangle(glm::dvec3 p, const std::array<glm::dvec3, 3>& t) {
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  bool inside = glm::length(normal) > 0.0;  // three corners in line have edges alone
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a = t[i], b = t[(i + 1) % 3];
    inside = inside && glm::dot(glm::cross(b - a, p - a), normal) >= 0.0;
    nearest = std::min(nearest, distance_to_segment(p, a, b));
  }
  return inside ? std::abs(glm::dot(p - t[0], normal)) / glm::length(normal) : nearest;
}

double distance_to_box(glm::dvec3 p, const scene::Box& box) {
  return glm::length(p - glm::clamp(p, glm::dvec3(box.lower), glm::dvec3(box.upper)));
}

}  // namespace

Clusters make_clusters(const scene::Geometry& geometry) {
  const auto count = static_cast<std::uint32_t>(geometry.triangles.size());
  const scene::Box box = scene::bounds(geometry);
  const glm::dvec3 extent = glm::max(glm::dvec3(box.upper) - glm::dvec3(box.lower), glm::dvec3(1e-30));

  // Order the triangles along a space-filling curve.
  std::vector<std::uint64_t> codes(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [a, b, c] = corners(geometry, i);
    const glm::dvec3 cell = ((a + b + c) / 3.0 - glm::dvec3(box.lower)) / extent * 2097151.0;
    codes[i] = spread_bits(static_cast<std::uint64_t>(cell.x)) |
               spread_bits(static_cast<std::uint64_t>(cell.y)) << 1 |
               spread_bits(static_cast<std::uint64_t>(cell.z)) << 2;
  }
  Clusters result;
  result.order.resize(count);
  std::iota(result.order.begin(), result.order.end(), 0u);
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  result.first_cut_out = count;
  if (scene::has_cut_outs(geometry)) {
    const auto first =
        std::stable_partition(result.order.begin(), result.order.end(),
                              [&](std::uint32_t triangle) { return !scene::is_cut_out(geometry, triangle); });
    result.first_cut_out = static_cast<std::uint32_t>(first - result.order.begin());
  }

  // Cut it.
  for (std::uint32_t first = 0; first < count;) {
    const std::uint32_t end = first < result.first_cut_out ? result.first_cut_out : count;
    result.clusters.push_back({first, std::min(k_cluster_triangles, end - first), {}});
    first += result.clusters.back().triangle_count;
  }
  fit_boxes(result, geometry);
  return result;
}

void fit_boxes(Clusters& clusters, const scene::Geometry& geometry) {
  for (Cluster& cluster : clusters.clusters) {
    cluster.box = {};
    for (std::uint32_t i = 0; i < cluster.triangle_count; ++i) {
      const glm::uvec3 triangle = geometry.triangles[clusters.order[cluster.first_triangle + i]];
      for (int corner = 0; corner < 3; ++corner) cluster.box.include(geometry.positions[triangle[corner]]);
    }
  }
}

std::vector<glm::dvec3> sides_of_cone(std::span<const glm::dvec3> directions, double rounding) {
  std::vector<glm::dvec3> sides;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t j = i + 1; j < directions.size(); ++j) {
      const glm::dvec3 across = glm::cross(directions[i], directions[j]);
      // Two that are all but parallel span no plane; what they would bound, others do.
      if (glm::length(across) < 1e-9) continue;
      const glm::dvec3 normal = glm::normalize(across);
      double least = 0.0, most = 0.0;
      for (const glm::dvec3& direction : directions) {
        least = std::min(least, glm::dot(normal, direction));
        most = std::max(most, glm::dot(normal, direction));
      }
      if (least >= -rounding) sides.push_back(normal);
      if (most <= rounding) sides.push_back(-normal);
    }
  }
  return sides;
}

bool may_touch(glm::dvec3 apex, std::span<const glm::dvec3> inward, const scene::Box& box) {
  const glm::dvec3 centre = (glm::dvec3(box.lower) + glm::dvec3(box.upper)) * 0.5 - apex;
  const glm::dvec3 half = (glm::dvec3(box.upper) - glm::dvec3(box.lower)) * 0.5;
  // A box outside one of the planes is outside the region; the slack covers rounding to float on the GPU.
  const double slack = 1e-5 * (glm::length(centre) + glm::length(half));
  return std::all_of(inward.begin(), inward.end(), [&](const glm::dvec3& n) {
    return glm::dot(n, centre) + glm::dot(glm::abs(n), half) >= -slack * glm::length(n);
  });
}

bool may_touch(const Pyramid& pyramid, const scene::Box& box) {
  return may_touch(pyramid.apex,
                   std::array{pyramid.forward, pyramid.forward * pyramid.half_width + pyramid.right,
                              pyramid.forward * pyramid.half_width - pyramid.right,
                              pyramid.forward * pyramid.half_height + pyramid.up,
                              pyramid.forward * pyramid.half_height - pyramid.up},
                   box);
}

double distance_to_geometry(const scene::Geometry& geometry, const Clusters& clusters, glm::dvec3 point) {
  std::vector<std::pair<double, const Cluster*>> by_distance;
  by_distance.reserve(clusters.clusters.size());
  for (const Cluster& cluster : clusters.clusters)
    by_distance.emplace_back(distance_to_box(point, cluster.box), &cluster);
  std::sort(by_distance.begin(), by_distance.end());

  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [box_distance, cluster] : by_distance) {
    if (box_distance >= nearest) break;
    for (std::uint32_t i = 0; i < cluster->triangle_count; ++i) {
      const std::uint32_t triangle = clusters.order[cluster->first_triangle + i];
      nearest = std::min(nearest, distance_to_triangle(point, corners(geometry, triangle)));
    }
  }
  return nearest;
}

std::vector<std::uint32_t> triangles_within(const scene::Geometry& geometry, const Clusters& clusters,
                                            glm::dvec3 point, double reach) {
  std::vector<std::uint32_t> places;
  for (const Cluster& cluster : clusters.clusters) {
    if (distance_to_box(point, cluster.box) > reach) continue;
    const std::uint32_t end = cluster.first_triangle + cluster.triangle_count;
    for (std::uint32_t place = cluster.first_triangle; place < end; ++place) {
      if (distance_to_triangle(point, corners(geometry, clusters.order[place])) <= reach)
        places.push_back(place);
    }
  }
  return places;
}

}  // namespace airlight::frame
