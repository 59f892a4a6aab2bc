#include "surface_shadows/median_tree.h"

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>

#include "shared.h"

namespace airlight::shaders {
#include "surface_shadows/apparent.glsl"
}  // namespace airlight::shaders

namespace airlight::surface_shadows {
namespace {

constexpr int k_candidates = 8;  ///< of which the pivot is taken
constexpr int k_witnesses = 24;  ///< that say how far each candidate is from the others

shaders::Apparent apparent(const MetricNode& node) {
  return {node.from, node.to, node.width};
}

class Builder {
 public:
  Builder(std::span<MetricNode> nodes, const MedianTreeView& view, std::uint32_t seed)
      : nodes_(nodes),
        observer_{{view.travels, view.is_sun}, view.error},
        slack_(view.slack),
        random_(seed),
        limits_(nodes.size(), 0.0f) {}

  std::vector<float> build() {
    for (std::uint32_t node = 1; node < nodes_.size(); ++node)
      if (nodes_[node].width >= 0.0f) left_.push_back({node, {}});
    // Sets whose tree is not yet there, and where it belongs: chains of clusters that overlap may be long.
    std::vector<Set> sets = {{0, left_.size(), 0, 0}};
    while (!sets.empty()) {
      const Set set = sets.back();
      sets.pop_back();
      if (set.first == set.end) continue;
      const std::array<std::size_t, 2> ends = split(set);
      const std::uint32_t pivot = left_[set.first].node;
      sets.push_back({set.first + 1, ends[0], pivot, shaders::k_near});
      sets.push_back({ends[0], ends[1], pivot, shaders::k_far});
      sets.push_back({ends[1], set.end, pivot, shaders::k_overlap});
    }
    return std::move(limits_);
  }

 private:
  struct Element {
    std::uint32_t node;
    glm::vec2 distances;  ///< from the pivot: the least and the greatest
    float middle() const { return 0.5f * (distances.x + distances.y); }
  };
  struct Set {
    std::size_t first, end;  ///< in `left_`
    std::uint32_t parent, child;
  };

  glm::vec2 distances(std::uint32_t pivot, std::uint32_t other) const {
    return shaders::distances_to(observer_, apparent(nodes_[pivot]), apparent(nodes_[other]));
  }

  std::size_t any(const Set& set) { return set.first + random_() % (set.end - set.first); }

  /// The one of some candidates whose distances to some others are the farthest from their median, squared.
  std::size_t choose_pivot(const Set& set) {
    std::size_t best = set.first;
    float most = -1.0f;
    for (int i = 0; i < k_candidates; ++i) {
      const std::size_t candidate = any(set);
      std::array<float, k_witnesses> away;
      for (float& distance : away) {
        const glm::vec2 d = distances(left_[candidate].node, left_[any(set)].node);
        distance = 0.5f * (d.x + d.y);
      }
      std::nth_element(away.begin(), away.begin() + k_witnesses / 2, away.end());
      const float median = away[k_witnesses / 2];
      float spread = 0.0f;
      for (const float distance : away) spread += (distance - median) * (distance - median);
      if (spread <= most) continue;
      most = spread;
      best = candidate;
    }
    return best;
  }

  /// Brings the pivot to the front and sorts the others by child. @returns where what is near ends, and where
  /// what is beyond does
  std::array<std::size_t, 2> split(const Set& set) {
    std::swap(left_[set.first], left_[choose_pivot(set)]);
    const std::uint32_t own = left_[set.first].node;
    MetricNode& pivot = nodes_[own];
    nodes_[set.parent].children[set.child] = own;
    pivot.place = 4 * set.parent + set.child;
    pivot.least_depth = pivot.depth;
    const auto begin = left_.begin() + static_cast<std::ptrdiff_t>(set.first + 1);
    const auto end = left_.begin() + static_cast<std::ptrdiff_t>(set.end);
    if (begin == end) return {set.end, set.end};

    for (auto other = begin; other != end; ++other) {
      other->distances = distances(own, other->node);
      pivot.least_depth = std::min(pivot.least_depth, nodes_[other->node].depth);
    }
    const auto median = begin + (end - begin) / 2;
    std::nth_element(begin, median, end,
                     [](const Element& a, const Element& b) { return a.middle() < b.middle(); });
    const float limit = median->middle();
    limits_[own] = limit;
    const auto is_of = [&](std::uint32_t child) {
      return [this, limit, child](const Element& element) {
        return shaders::side_of(element.distances, limit, slack_) == child;
      };
    };
    const auto end_of_near = std::partition(begin, end, is_of(shaders::k_near));
    const auto end_of_far = std::partition(end_of_near, end, is_of(shaders::k_far));
    for (auto other = end_of_far; other != end; ++other) {
      pivot.overlap_least = std::min(pivot.overlap_least, other->distances.x);
      pivot.overlap_most = std::max(pivot.overlap_most, other->distances.y);
    }
    return {static_cast<std::size_t>(end_of_near - left_.begin()),
            static_cast<std::size_t>(end_of_far - left_.begin())};
  }

  std::span<MetricNode> nodes_;
  shaders::Observer observer_;
  float slack_;
  std::minstd_rand random_;
  std::vector<float> limits_;
  std::vector<Element> left_;
};

}  // namespace

std::vector<float> link_median_tree(std::span<MetricNode> nodes, const MedianTreeView& view,
                                    std::uint32_t seed) {
  return Builder(nodes, view, seed).build();
}

}  // namespace airlight::surface_shadows
