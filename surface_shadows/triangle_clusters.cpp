#include "surface_shadows/triangle_clusters.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace airlight::surface_shadows {
namespace {

constexpr std::size_t k_chunk = 512;     ///< triangles that k-means starts with
constexpr std::size_t k_most_means = 8;  ///< of one cut, as Meister and Bittner have it, …
constexpr int k_rounds = 5;              ///< … and how often the means are moved
constexpr int k_candidates = 4;          ///< for a mean, of which the farthest from the others is taken

/// A triangle's box. Meister's distance of two: that of their lower corners and that of their upper ones,
/// squared and summed.
struct Extent {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
};

double distance2(const Extent& a, const Extent& b) {
  const glm::dvec3 lower = a.lower - b.lower, upper = a.upper - b.upper;
  return glm::dot(lower, lower) + glm::dot(upper, upper);
}

/// Cuts one chunk.
class Chunk {
 public:
  /// @param places in the order of triangles; sorted by cluster in the end
  Chunk(std::span<const Extent> extents, std::span<std::uint32_t> places, std::size_t most,
        std::uint32_t seed)
      : extents_(extents), places_(places), most_(most), random_(seed) {}

  /// @returns where each cluster ends in `places`
  std::vector<std::size_t> cut() {
    cut_run(0, places_.size());
    return ends_;
  }

 private:
  void cut_run(std::size_t first, std::size_t end) {
    const std::size_t count = end - first;
    if (count <= most_) {
      ends_.push_back(end);
      return;
    }
    const std::size_t mean_count = std::min(k_most_means, (count + most_ - 1) / most_);
    std::vector<std::size_t> ends = sort_by_mean(first, end, mean_count);
    // Triangles that are all alike have one mean.
    if (ends.size() == 1) ends.insert(ends.begin(), first + count / 2);
    for (const std::size_t part_end : ends) {
      cut_run(first, part_end);
      first = part_end;
    }
  }

  const Extent& extent(std::size_t i) const { return extents_[places_[i]]; }

  /// k-means++ among a few candidates: each next mean is the one of them that is farthest from those chosen.
  std::vector<Extent> choose_means(std::size_t first, std::size_t end, std::size_t count) {
    const auto any = [&] { return extent(first + random_() % (end - first)); };
    std::vector<Extent> means = {any()};
    while (means.size() < count) {
      Extent farthest;
      double most = -1.0;
      for (int i = 0; i < k_candidates; ++i) {
        const Extent candidate = any();
        double least = std::numeric_limits<double>::infinity();
        for (const Extent& mean : means) least = std::min(least, distance2(mean, candidate));
        if (least <= most) continue;
        most = least;
        farthest = candidate;
      }
      means.push_back(farthest);
    }
    return means;
  }

  /// Sorts a run by nearest mean. @returns where each mean's triangles end, of those that have any
  std::vector<std::size_t> sort_by_mean(std::size_t first, std::size_t end, std::size_t mean_count) {
    std::vector<Extent> means = choose_means(first, end, mean_count);
    std::vector<std::size_t> nearest(end - first);
    for (int round = 0; round < k_rounds; ++round) {
      std::vector<Extent> sums(mean_count, {glm::dvec3(0.0), glm::dvec3(0.0)});
      std::vector<double> counts(mean_count, 0.0);
      for (std::size_t i = first; i < end; ++i) {
        std::size_t best = 0;
        for (std::size_t k = 1; k < mean_count; ++k)
          if (distance2(means[k], extent(i)) < distance2(means[best], extent(i))) best = k;
        nearest[i - first] = best;
        sums[best].lower += extent(i).lower;
        sums[best].upper += extent(i).upper;
        counts[best] += 1.0;
      }
      for (std::size_t k = 0; k < mean_count; ++k)
        if (counts[k] > 0.0) means[k] = {sums[k].lower / counts[k], sums[k].upper / counts[k]};
    }
    std::vector<std::uint32_t> sorted;
    std::vector<std::size_t> ends;
    for (std::size_t k = 0; k < mean_count; ++k) {
      const std::size_t before = sorted.size();
      for (std::size_t i = first; i < end; ++i)
        if (nearest[i - first] == k) sorted.push_back(places_[i]);
      if (sorted.size() > before) ends.push_back(first + sorted.size());
    }
    std::copy(sorted.begin(), sorted.end(), places_.begin() + static_cast<std::ptrdiff_t>(first));
    return ends;
  }

  std::span<const Extent> extents_;
  std::span<std::uint32_t> places_;
  std::size_t most_;
  std::minstd_rand random_;
  std::vector<std::size_t> ends_;
};

}  // namespace

TriangleClusters make_triangle_clusters(const scene::Geometry& geometry, std::span<const std::uint32_t> order,
                                        std::span<const std::uint32_t> part_of_triangle,
                                        const ClusterSettings& settings,
                                        std::span<const std::uint32_t> object_of_triangle,
                                        const scene::Progress& progress) {
  TriangleClusters result;
  result.triangles.resize(order.size());
  std::iota(result.triangles.begin(), result.triangles.end(), 0u);
  const auto part_of = [&](std::uint32_t place) {
    return part_of_triangle.empty() ? 0u : part_of_triangle[place];
  };
  const auto group_of = [&](std::uint32_t place) {
    return std::pair(object_of_triangle.empty() ? 0u : object_of_triangle[place], part_of(place));
  };
  std::stable_sort(result.triangles.begin(), result.triangles.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return group_of(a) < group_of(b); });

  std::vector<Extent> extents(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const glm::uvec3 t = geometry.triangles[order[i]];
    for (const glm::uint corner : {t.x, t.y, t.z}) {
      extents[i].lower = glm::min(extents[i].lower, glm::dvec3(geometry.positions[corner]));
      extents[i].upper = glm::max(extents[i].upper, glm::dvec3(geometry.positions[corner]));
    }
  }

  // Chunks, none of which spans parts or objects.
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_first = i == 0 || group_of(result.triangles[i]) != group_of(result.triangles[i - 1]);
    if (is_first || i - starts.back() == k_chunk) starts.push_back(i);
  }
  starts.push_back(order.size());

  // Their clusters, each chunk for itself.
  std::vector<std::vector<TriangleCluster>> of_chunks(starts.size() - 1);
  const auto cut_chunk = [&](int part) {
    const auto chunk = static_cast<std::size_t>(part);
    const std::span<std::uint32_t> places =
        std::span(result.triangles).subspan(starts[chunk], starts[chunk + 1] - starts[chunk]);
    std::size_t first = 0;
    for (const std::size_t end :
         Chunk(extents, places, settings.most_triangles, static_cast<std::uint32_t>(chunk + 1)).cut()) {
      std::vector<glm::uvec3> triangles;
      for (const std::uint32_t place : places.subspan(first, end - first))
        triangles.push_back(geometry.triangles[order[place]]);
      of_chunks[chunk].push_back(
          {bounds_of(geometry, triangles, settings.has_capsules),
           static_cast<std::uint32_t>(starts[chunk] + first),
           static_cast<std::uint32_t>(end - first) + k_part_unit * part_of(places[first])});
      first = end;
    }
  };
  scene::parallel(
      static_cast<int>(of_chunks.size()), [&] { return cut_chunk; }, progress);
  for (const std::vector<TriangleCluster>& of_chunk : of_chunks)
    result.clusters.insert(result.clusters.end(), of_chunk.begin(), of_chunk.end());
  return result;
}

}  // namespace airlight::surface_shadows
