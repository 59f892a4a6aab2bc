#include "surface_shadows/median_tree.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "frame/blocks.h"
#include "support/random.h"

namespace airlight::shaders {
#include "surface_shadows/apparent.glsl"
}  // namespace airlight::shaders

namespace airlight::surface_shadows {
namespace {

/// Nodes as the GPU leaves them: arcs of a lamp's directions, or of feet on a sun's plane.
std::vector<MetricNode> any_nodes(int count, bool is_sun) {
  tests::Random random(6);
  std::vector<MetricNode> nodes(static_cast<std::size_t>(count) + 1);
  for (MetricNode& node : nodes) {
    glm::dvec3 from = is_sun ? random.in_box(1.0) : random.direction();
    glm::dvec3 to = from + random.logarithmic(1e-3, 0.2) * random.direction();
    if (is_sun)
      from.y = to.y = 0.0;
    else
      to = glm::normalize(to);
    node = {.from = glm::vec3(from),
            .width = static_cast<float>(random.logarithmic(1e-3, 0.3)),
            .to = glm::vec3(random.uniform(0, 1) < 0.5 ? from : to),
            .least_depth = 0,
            .children = {0, 0, 0},
            .place = 0,
            .overlap_least = std::numeric_limits<float>::infinity(),
            .overlap_most = 0.0f,
            .depth = static_cast<std::uint32_t>(random.uniform(1, 1e9)),
            .leaves_out_fronts = 0};
  }
  nodes[0].place = 7;
  return nodes;
}

MedianTreeView view_of(bool is_sun) {
  const float error = is_sun ? 2.0f * shaders::k_foot_error : shaders::k_angle_error;
  return {{0, -1, 0}, is_sun, error, shaders::k_decisions * error};
}

/// What the query relies on, of all below a node. @returns its members
std::vector<std::uint32_t> expect_sound(const std::vector<MetricNode>& nodes,
                                        const std::vector<float>& limits, const MedianTreeView& view,
                                        std::uint32_t root) {
  const shaders::Observer observer{{view.travels, view.is_sun}, view.error};
  const MetricNode& pivot = nodes[root];
  std::vector<std::uint32_t> all = {root};
  std::uint32_t least_depth = pivot.depth;
  for (std::uint32_t child = 0; child < 3; ++child) {
    const std::uint32_t below = pivot.children[child];
    if (below == 0) continue;
    EXPECT_EQ(nodes[below].place, 4 * root + child);
    const std::vector<std::uint32_t> members = expect_sound(nodes, limits, view, below);
    least_depth = std::min(least_depth, nodes[below].least_depth);
    for (const std::uint32_t member : members) {
      const glm::vec2 distances =
          shaders::distances_to(observer, {pivot.from, pivot.to, pivot.width},
                                {nodes[member].from, nodes[member].to, nodes[member].width});
      EXPECT_EQ(shaders::side_of(distances, limits[root], view.slack), child);
      if (child != shaders::k_overlap) continue;
      EXPECT_LE(pivot.overlap_least, distances.x);
      EXPECT_GE(pivot.overlap_most, distances.y);
    }
    all.insert(all.end(), members.begin(), members.end());
  }
  EXPECT_EQ(pivot.least_depth, least_depth);
  return all;
}

TEST(MedianTree, HasEveryNodeOnceOnItsSideOfEachPivot) {
  for (const bool is_sun : {false, true}) {
    const MedianTreeView view = view_of(is_sun);
    std::vector<MetricNode> nodes = any_nodes(300, is_sun);
    for (std::size_t i = 1; i < nodes.size(); i += 10) nodes[i].width = -1.0f;
    const std::vector<float> limits = link_median_tree(nodes, view, 1);
    EXPECT_EQ(nodes[0].place, 7u) << "it stands for something else";
    std::vector<std::uint32_t> all = expect_sound(nodes, limits, view, nodes[0].children[0]);
    std::sort(all.begin(), all.end());
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 1; i < nodes.size(); ++i)
      if (nodes[i].width >= 0.0f) expected.push_back(i);
    EXPECT_EQ(all, expected);
  }
}

TEST(MedianTree, CutsSmallThingsInHalves) {
  std::vector<MetricNode> nodes = any_nodes(255, false);
  for (MetricNode& node : nodes) {
    node.to = node.from;
    node.width = 1e-4f;
  }
  link_median_tree(nodes, view_of(false), 1);
  std::vector<int> depth(nodes.size(), 0);
  std::vector<std::uint32_t> left = {nodes[0].children[0]};
  int deepest = 0;
  while (!left.empty()) {
    const std::uint32_t node = left.back();
    left.pop_back();
    for (const std::uint32_t child : nodes[node].children) {
      if (child == 0) continue;
      depth[child] = depth[node] + 1;
      deepest = std::max(deepest, depth[child]);
      left.push_back(child);
    }
  }
  EXPECT_LE(deepest, 9) << "of a tree that is even all through, 7";
}

TEST(MedianTree, OfThingsThatAreAllAlikeAndOfNone) {
  std::vector<MetricNode> nodes = any_nodes(200, false);
  std::fill(nodes.begin() + 1, nodes.end(), nodes[1]);
  const std::vector<float> limits = link_median_tree(nodes, view_of(false), 1);
  EXPECT_EQ(expect_sound(nodes, limits, view_of(false), nodes[0].children[0]).size(), 200u);
  nodes.resize(1);
  nodes[0].children = {};
  EXPECT_EQ(link_median_tree(nodes, view_of(false), 1).size(), 1u);
  EXPECT_EQ(nodes[0].children[0], 0u);
}

}  // namespace
}  // namespace airlight::surface_shadows
