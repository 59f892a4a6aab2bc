#include "scene/nodes.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

namespace airlight::scene {

glm::dmat4 parent_from_node(const Node& node) {
  if (node.matrix) return *node.matrix;
  const glm::dmat4 turned = glm::translate(glm::dmat4(1.0), node.translation) * glm::mat4_cast(node.rotation);
  return glm::scale(turned, node.scale);
}

std::vector<std::uint32_t> chain_to(std::span<const Node> nodes, std::uint32_t node) {
  std::vector<std::uint32_t> chain = {node};
  while (const auto parent = nodes[chain.back()].parent) chain.push_back(*parent);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

glm::dmat4 world_from_node(std::span<const Node> nodes, std::uint32_t node) {
  glm::dmat4 matrix(1.0);
  for (const std::uint32_t link : chain_to(nodes, node)) matrix = matrix * parent_from_node(nodes[link]);
  return matrix;
}

std::vector<std::uint32_t> nearest_of(std::span<const Node> nodes, std::span<const std::uint32_t> some) {
  constexpr std::uint32_t k_unknown = ~0u;
  std::vector<std::uint32_t> nearest(nodes.size(), k_unknown);
  for (std::size_t i = 0; i < some.size(); ++i) nearest[some[i]] = static_cast<std::uint32_t>(i + 1);
  // Up to what is known, and down again: chains of nodes can be as long as the file.
  std::vector<std::uint32_t> climbed;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    std::optional<std::uint32_t> node = i;
    for (climbed.clear(); node && nearest[*node] == k_unknown; node = nodes[*node].parent)
      climbed.push_back(*node);
    for (const std::uint32_t below : climbed) nearest[below] = node ? nearest[*node] : 0;
  }
  return nearest;
}

}  // namespace airlight::scene
