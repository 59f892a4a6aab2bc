#include "epipolar/populate_conservative.h"

#include "spirv/epipolar/populate_conservative_comp.h"
#include "spirv/epipolar/populate_conservative_queue_comp.h"

namespace airlight::epipolar {
namespace {

/// The head of the queue in shaders/epipolar/populate_conservative.glsl.
struct QueueHead {
  std::uint32_t many_groups[3], many_count, most_groups[3], most_count, triangles;
};

gpu::Program load_queue(const Resolution& resolution, std::uint32_t from_back) {
  const auto grid = resolution_constants(resolution);
  return gpu::Program::compute(k_populate_conservative_queue_comp,
                               std::array{grid[0], grid[1], grid[2], gpu::Constant(3, from_back)});
}

}  // namespace

PopulateConservative::PopulateConservative(const Resolution& resolution)
    : few_(gpu::Program::compute(k_populate_conservative_comp, resolution_constants(resolution))),
      many_(load_queue(resolution, 0)),
      most_(load_queue(resolution, 1)) {}

void PopulateConservative::run(const Grid& grid, const frame::SceneBuffers& scene) {
  constexpr std::uint32_t k_row = 256, k_groups_of_most = 16;
  const std::uint32_t triangles = scene.triangle_count();
  const auto bytes = static_cast<std::int64_t>(sizeof(QueueHead) + 4 * std::size_t{triangles});
  if (queue_.bytes() != bytes) queue_ = gpu::Buffer(bytes);
  const QueueHead head = {{k_row, 0, 1}, 0, {k_row, 0, k_groups_of_most}, 0, triangles};
  queue_.write(&head, sizeof head);
  grid.first_shadowed().clear(static_cast<std::uint32_t>(grid.resolution().alpha));
  scene.bind_samplers();
  queue_.bind_storage(8);
  few_.dispatch({triangles, 1, 1}, {64, 1, 1});
  many_.dispatch_indirect(queue_, offsetof(QueueHead, many_groups));
  most_.dispatch_indirect(queue_, offsetof(QueueHead, most_groups));
}

}  // namespace airlight::epipolar
