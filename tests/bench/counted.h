#pragma once

#include <map>
#include <string>
#include <vector>

#include "frame/methods.h"

namespace airlight::bench {

/// A method that asks a tree once a pixel, psv or metric-tree; counts the nodes that each pixel visits, as
/// well.
template <class Tree>
class Counted : public Tree {
 public:
  using Tree::Tree;
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override {
    Tree::query(inputs, visibility);
    if (!counts) return;
    const gpu::Texture of_pixels(gpu::Format::r32f, visibility.size());
    this->count_nodes(inputs, of_pixels);
    nodes = of_pixels.read<float>();
    sums = Tree::counters(inputs);
  }

  bool counts = true;
  std::map<std::string, double> sums;  ///< of that frame, summed over its pixels
  std::vector<float> nodes;            ///< of the last frame that was counted; row 0 at the top
};

}  // namespace airlight::bench
