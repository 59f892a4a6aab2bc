#include "epipolar/populate_screen_space.h"

#include "frame/blocks.h"

#include <algorithm>
#include <numeric>

#include "scene/components.h"

#include "spirv/epipolar/populate_screen_space_comp.h"
#include "spirv/epipolar/screen_space_resolve_comp.h"

namespace airlight::epipolar {
namespace {

bool touch(const scene::Box& a, const scene::Box& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  return true;
}

}  // namespace

std::vector<std::uint32_t> deal_apart(const std::vector<scene::Box>& boxes) {
  std::vector<std::uint32_t> order(boxes.size()), group(boxes.size(), 0), open;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return boxes[a].lower.x < boxes[b].lower.x; });
  std::vector<bool> is_taken;
  for (const std::uint32_t box : order) {
    // Sweeping along x, a box that ends before this one starts touches none of the following.
    std::erase_if(open, [&](std::uint32_t other) { return boxes[other].upper.x < boxes[box].lower.x; });
    is_taken.assign(is_taken.size(), false);
    for (const std::uint32_t other : open)
      if (touch(boxes[box], boxes[other])) is_taken[group[other]] = true;
    const auto free = std::find(is_taken.begin(), is_taken.end(), false);
    group[box] = static_cast<std::uint32_t>(free - is_taken.begin());
    if (free == is_taken.end()) is_taken.push_back(true);
    open.push_back(box);
  }
  return group;
}

PopulateScreenSpace::PopulateScreenSpace(const gpu::Limits& limits, const Grid& grid)
    : limits_(limits),
      crossings_(grid.resolution(), k_populate_screen_space_comp),
      resolve_(gpu::Pipeline::compute(k_screen_space_resolve_comp, resolution_constants(grid.resolution()))) {
  const Resolution& n = grid.resolution();
  int planes = 0;
  for (const Window& window : grid.windows()) planes = std::max(planes, window.planes);
  flips_ = gpu::Buffer(std::int64_t{n.alpha} * planes * n.phi / 8);
  flip_texels_ = {limits, flips_, gpu::Format::rgba32ui, "the crossings of the screen-space voxelization"};
}

void PopulateScreenSpace::load(const frame::FrameInputs& inputs) {
  const scene::Geometry& geometry = inputs.geometry();
  const scene::Components& components = inputs.components();
  const std::vector<std::uint32_t> pass_of_component = deal_apart(scene::boxes_of(components, geometry));
  const auto pass_of = [&](std::uint32_t triangle) {
    return pass_of_component[components.of_triangle[triangle]];
  };

  std::vector<std::uint32_t> order(geometry.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return pass_of(a) < pass_of(b); });
  std::vector<glm::uvec3> triangles;
  passes_.clear();
  for (const std::uint32_t triangle : order) {
    if (pass_of(triangle) == passes_.size())
      passes_.push_back({static_cast<std::uint32_t>(triangles.size()), 0});
    ++passes_.back().count;
    triangles.push_back(geometry.triangles[triangle]);
  }
  triangles_ = gpu::Buffer::from(std::span<const glm::uvec3>(triangles));
  triangle_texels_ = {limits_, triangles_, gpu::Format::rgb32ui, "the model's triangles"};
  scene_ = inputs.scene.id();
}

void PopulateScreenSpace::run(const frame::FrameInputs& inputs, const Grid& grid) {
  if (scene_ != inputs.scene.id()) load(inputs);
  grid.bits().clear();
  inputs.scene.bind_samplers();
  triangle_texels_.bind_sampler(shaders::k_triangles_unit);
  flips_.bind_storage(shaders::k_scratch_storage);
  flip_texels_.bind_sampler(shaders::k_scratch_unit);
  for (const Window& window : grid.windows()) {
    grid.bind_window(window);
    crossings_.set_window(window);
    set_window(resolve_, window);
    for (const Pass& pass : passes_) {
      flips_.clear();
      crossings_.run(pass.first, pass.count);
      resolve_.dispatch({grid.resolution().alpha, window.planes, 1});
    }
  }
}

}  // namespace airlight::epipolar
