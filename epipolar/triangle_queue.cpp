#include "epipolar/triangle_queue.h"

#include <algorithm>
#include <cstddef>

#include "epipolar/space_math.h"

namespace airlight::epipolar {
namespace {

/// The head of the queue's storage buffer (std430).
struct QueueHead {
  std::uint32_t many_groups[3], many_count, most_groups[3], most_count, first_triangle, triangle_count;
};

/// @param pass see shaders/epipolar/triangle_passes.glsl
gpu::Pipeline load(const Resolution& resolution, std::span<const std::uint32_t> spirv, std::uint32_t pass) {
  const auto grid = resolution_constants(resolution);
  return gpu::Pipeline::compute(spirv, std::array{grid[0], grid[1], grid[2], gpu::Constant(3, pass)});
}

}  // namespace

TriangleQueue::TriangleQueue(const Resolution& resolution, std::span<const std::uint32_t> spirv)
    : all_(load(resolution, spirv, 0)),
      many_(load(resolution, spirv, 1)),
      most_(load(resolution, spirv, 2)) {}

void TriangleQueue::set_window(const Window& window) {
  for (const gpu::Pipeline* program : {&all_, &many_, &most_}) epipolar::set_window(*program, window);
}

void TriangleQueue::run(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t k_row = 256, k_groups_of_most = 16;
  constexpr std::uint32_t k_at_once = 1 << 21;  // 32768 groups; every driver dispatches 65535
  const std::uint32_t longest = std::min(count, k_at_once);
  const auto bytes = static_cast<std::int64_t>(sizeof(QueueHead) + 4 * std::size_t{longest});
  if (queue_.bytes() < bytes) queue_ = gpu::Buffer(bytes);
  queue_.bind_storage(shaders::k_queue_storage);
  for (std::uint32_t done = 0; done < count; done += k_at_once) {
    const std::uint32_t part = std::min(count - done, k_at_once);
    const QueueHead head = {{k_row, 0, 1}, 0, {k_row, 0, k_groups_of_most}, 0, first + done, part};
    queue_.write(&head, sizeof head);
    all_.dispatch({part, 1, 1});
    many_.dispatch_indirect(queue_, offsetof(QueueHead, many_groups));
    most_.dispatch_indirect(queue_, offsetof(QueueHead, most_groups));
  }
}

}  // namespace airlight::epipolar
