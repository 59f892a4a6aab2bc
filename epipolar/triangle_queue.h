#pragma once

#include "epipolar/grid.h"
#include "gpu/pipeline.h"

namespace airlight::epipolar {

/// Runs a compute shader over triangles that differ much in size: one invocation a small triangle, one work
/// group or sixteen a large one (shaders/epipolar/triangle_queue.glsl).
class TriangleQueue {
 public:
  /// @param spirv an entry point that includes shaders/epipolar/triangle_passes.glsl
  TriangleQueue(const Resolution& resolution, std::span<const std::uint32_t> spirv);

  /// See epipolar::set_window; for shaders that work on one.
  void set_window(const Window& window);

  /// Triangles `first` to `first` + `count` − 1 of the bound ones, some two million at a time.
  void run(std::uint32_t first, std::uint32_t count);

 private:
  gpu::Pipeline all_, many_, most_;
  gpu::Buffer queue_;
};

}  // namespace airlight::epipolar
