#include "epipolar/volume.h"

#include "epipolar/space.h"

#include "spirv/epipolar/phi_range_comp.h"

namespace airlight::epipolar {

ShadowVolume::ShadowVolume(const gpu::Context& context, const Resolution& resolution, Scan scan)
    : grid_(context, resolution), phi_range_(gpu::Program::compute(k_phi_range_comp)) {
  if (scan == Scan::fused) {
    populate_scan_.emplace(resolution);
  } else {
    populate_.emplace(resolution);
    scan_.emplace(resolution);
  }
}

shaders::EpipolarBlock ShadowVolume::find_ranges(const frame::FrameInputs& inputs) const {
  const shaders::EpipolarBlock block = epipolar_block(inputs.view, grid_.resolution().alpha);
  inputs.timer.time("ranges", [&] {
    grid_.block().write(&block, sizeof block);
    grid_.phi_range().clear();
    grid_.bind();
    inputs.surfaces.bind_sampler(0);
    const glm::uvec2 size = inputs.view.size;
    phi_range_.dispatch({size.x, (size.y + 31) / 32, 1}, {64, 1, 1});
  });
  return block;
}

void ShadowVolume::fill(const frame::FrameInputs& inputs) const {
  if (populate_scan_) {
    inputs.timer.time("populate_scan", [&] { populate_scan_->run(grid_, *inputs.shadow_map); });
  } else {
    inputs.timer.time("populate", [&] { populate_->run(grid_, *inputs.shadow_map); });
    inputs.timer.time("scan", [&] { scan_->run(grid_); });
  }
}

}  // namespace airlight::epipolar
