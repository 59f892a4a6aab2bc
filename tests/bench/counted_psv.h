#pragma once

#include <vector>

#include "surface_shadows/psv.h"

namespace airlight::bench {

/// Counts the nodes that each pixel visits, as well.
class CountedPsv : public surface_shadows::Psv {
 public:
  using Psv::Psv;
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override {
    Psv::query(inputs, visibility);
    if (!counts) return;
    const gpu::Texture of_pixels(gpu::Format::r32f, visibility.size());
    count_nodes(inputs, of_pixels);
    nodes = of_pixels.read<float>();
  }

  bool counts = true;
  std::vector<float> nodes;  ///< of the last frame that was counted; row 0 at the top
};

}  // namespace airlight::bench
