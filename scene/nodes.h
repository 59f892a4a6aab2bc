#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace airlight::scene {

/// A node of a glTF file: it places its mesh, and all that hangs on it, within its parent.
struct Node {
  std::string name;                          ///< as the file has it; may be empty
  std::optional<std::uint32_t> parent = {};  ///< of the same file
  bool is_shown = false;                     ///< it belongs to the scene that is shown
  std::size_t cameras_and_lights = 0;        ///< that hang on it itself
  glm::dvec3 translation{0.0};               ///< within the parent
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};   ///< within the parent, of unit length
  glm::dvec3 scale{1.0};                     ///< before rotation and translation
  std::optional<glm::dmat4> matrix = {};     ///< in the place of these three
};

/// Whether files may mean a rotation by it: exporters write single precision.
inline bool is_unit_quaternion(const glm::dquat& rotation) {
  return std::abs(glm::length(rotation) - 1.0) < 1e-3;
}

glm::dmat4 parent_from_node(const Node& node);

/// A node and all nodes that it hangs on, the outermost first.
std::vector<std::uint32_t> chain_to(std::span<const Node> nodes, std::uint32_t node);

/// The product of these nodes' transforms.
glm::dmat4 world_from_node(std::span<const Node> nodes, std::uint32_t node);

/// Of each node, the nearest of some that it hangs on, itself included: its place among those, from 1; 0 for
/// none.
std::vector<std::uint32_t> nearest_of(std::span<const Node> nodes, std::span<const std::uint32_t> some);

}  // namespace airlight::scene
