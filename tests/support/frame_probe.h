#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "epipolar/volume.h"
#include "frame/frame.h"
#include "frame/none.h"
#include "support/gpu_context.h"

namespace airlight::tests {

/// Plugs into the frame where airlight does, and looks at what a method is given.
class FrameProbe : public frame::Airlight {
 public:
  using Look = std::function<void(const frame::FrameInputs&)>;
  explicit FrameProbe(Look look) : look_(std::move(look)) {}
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture&) override { look_(inputs); }

 private:
  Look look_;
};

/// Renders a frame up to where airlight plugs in, and calls `look` there.
inline void look_into_frame(const scene::Geometry& geometry, const scene::View& view, int shadow_map_size,
                            const FrameProbe::Look& look) {
  frame::Frame frame(gpu_context(), geometry, shadow_map_size);
  frame::NoShadow no_shadow;
  FrameProbe probe(look);
  gpu::StageTimer timer(nullptr);
  frame.render(view, no_shadow, probe, timer);
}

/// Distances of the surfaces seen, along the unit view rays [m]; 0 for none.
inline std::vector<float> distances(const frame::FrameInputs& inputs) {
  std::vector<float> distances;
  for (const glm::vec4& surface : inputs.surfaces.read<glm::vec4>()) distances.push_back(surface.w);
  return distances;
}

/// Makes a shadow volume's cells in φ, whose ranges are found, grow by `growth` (shaders/epipolar/grid.glsl).
inline void set_growth(const epipolar::ShadowVolume& volume, float growth) {
  std::vector<float> range = volume.grid().phi_range().read<float>();
  range.at(1) = growth;
  volume.grid().phi_range().write(range.data(), volume.grid().phi_range().bytes());
}

/// How each half-plane of such a volume, once it is filled, cuts φ.
inline std::vector<shaders::PhiCells> phi_cells(const epipolar::ShadowVolume& volume) {
  const std::vector<float> range = volume.grid().phi_range().read<float>();
  const std::vector<glm::vec4> planes = volume.grid().planes().read<glm::vec4>();
  std::vector<shaders::PhiCells> cells;
  for (std::size_t of_cells = 1; of_cells < planes.size(); of_cells += 2) {
    cells.push_back({.phi_max = shaders::Angle(std::max(range.at(0), 1e-6f)),
                     .growth = range.at(1),
                     .count = shaders::Cell(static_cast<float>(volume.grid().resolution().phi)),
                     .first = planes[of_cells].z,
                     .per_cell = planes[of_cells].w});
  }
  return cells;
}

/// Builds a shadow volume whose cells in φ grow.
inline void build(epipolar::ShadowVolume& volume, const frame::FrameInputs& inputs, float growth) {
  volume.find_ranges(inputs);
  set_growth(volume, growth);
  volume.fill(inputs);
}

}  // namespace airlight::tests
