#include "epipolar/change_tree.h"

#include <fmt/format.h>

#include "epipolar/space_math.h"

#include "spirv/epipolar/change_tree_comp.h"

namespace airlight::epipolar {

ChangeTree::ChangeTree(const gpu::Limits& limits, const Resolution& resolution)
    : resolution_(resolution),
      program_(gpu::Pipeline::compute(k_change_tree_comp, resolution_constants(resolution))) {
  const std::int64_t nodes =
      std::int64_t{shaders::nodes_per_plane(static_cast<std::uint32_t>(resolution.phi))} * resolution.theta;
  constexpr const char* k_remedy = "ask for fewer cells with --theta, --phi";
  const std::string name = fmt::format("the tree of {} × {} light rays", resolution.theta, resolution.phi);
  gpu::require_texels(limits, nodes, name, k_remedy);
  gpu::require_storage_block(limits, 16 * nodes, name, k_remedy);
  nodes_ = gpu::Buffer(16 * nodes);
  texels_ = {limits, nodes_, gpu::Format::rgba32ui, name};
}

void ChangeTree::build() const {
  nodes_.bind_storage(shaders::k_grid_storage);
  const auto phi = static_cast<std::uint32_t>(resolution_.phi);
  for (std::uint32_t level = 0; level < shaders::tree_levels(phi); level += 2) {
    program_.set(0, level);
    program_.dispatch({(shaders::nodes_of_level(phi, level) + 3) / 4, resolution_.theta, 1});
  }
}

void ChangeTree::bind() const {
  texels_.bind_sampler(shaders::k_grid_unit);
}

}  // namespace airlight::epipolar
