#include "epipolar/volume.h"

#include <bit>
#include <utility>

#include "scene/error.h"

#include "spirv/epipolar/phi_range_comp.h"
#include "spirv/epipolar/planes_comp.h"
#include "spirv/epipolar/scatter_comp.h"

namespace airlight::epipolar {

Scan scan_of(const VolumeSettings& settings) {
  const Scan fastest = settings.populate == Populate::screen_space ? Scan::column : Scan::fused;
  return settings.scan.value_or(fastest);
}

void validate(const VolumeSettings& settings) {
  validate(settings.resolution);
  if (settings.populate == Populate::screen_space && scan_of(settings) == Scan::fused) {
    throw scene::Error(scene::ExitCode::usage, "scan=fused",
                       "the screen-space voxelization sets bits, and this scan reads none",
                       "use column or multi-pass");
  }
}

ShadowVolume::ShadowVolume(const gpu::Limits& limits, const VolumeSettings& settings)
    : settings_(settings),
      grid_(limits, settings.resolution),
      planes_(gpu::Pipeline::compute(k_planes_comp, resolution_constants(settings.resolution))),
      phi_range_(gpu::Pipeline::compute(k_phi_range_comp)),
      scatter_(gpu::Pipeline::compute(k_scatter_comp, resolution_constants(settings.resolution))) {
  validate(settings);
  switch (settings.populate) {
    case Populate::shadow_map:
      populate_shadow_map_.emplace(settings.resolution);
      break;
    case Populate::conservative:
      populate_conservative_.emplace(settings.resolution);
      break;
    case Populate::screen_space:
      populate_screen_space_.emplace(limits, grid_);
      break;
  }
  switch (scan_of(settings)) {
    case Scan::fused:
      fused_scan_.emplace(settings.resolution);
      break;
    case Scan::column:
      or_scan_.emplace(settings.resolution);
      break;
    case Scan::multi_pass:
      mip_scan_.emplace(limits, grid_);
      break;
  }
}

shaders::EpipolarBlock ShadowVolume::find_ranges(const frame::FrameInputs& inputs) const {
  shaders::EpipolarBlock block =
      epipolar_block(inputs.view, settings_.resolution, settings_.ranges, settings_.theta_cells);
  if (populate_screen_space_) {
    // It finds occluders on the grid's own view rays, those nearer the axis than the image included.
    const float count = static_cast<float>(settings_.resolution.alpha);
    block.alpha_step += std::exchange(block.alpha_min, 0.0f) / count;
  }
  inputs.timer.time("ranges", [&] {
    grid_.block().write(&block, sizeof block);
    grid_.phi_range().clear();
    grid_.bind();
    grid_.planes().bind_storage(9);
    planes_.dispatch({settings_.resolution.theta, 1, 1});
    if (settings_.ranges == Ranges::full) {
      const auto order_of_pi = std::bit_cast<std::uint32_t>(2.0f);
      grid_.phi_range().write(&order_of_pi, sizeof order_of_pi);
    } else {
      inputs.surfaces.bind_sampler(0);
      const glm::uvec2 size = inputs.view.size;
      phi_range_.dispatch({size.x, (size.y + 31) / 32, 1});
    }
  });
  return block;
}

void ShadowVolume::fill_unscanned(const frame::FrameInputs& inputs, bool with_bits) {
  if (populate_screen_space_) populate_screen_space_->run(grid_, inputs.scene);
  if (populate_shadow_map_) populate_shadow_map_->run(grid_, *inputs.shadow_map);
  if (populate_conservative_) populate_conservative_->run(grid_, inputs.scene);
  if (with_bits && !populate_screen_space_) {
    grid_.bits().clear();
    dispatch_planes(scatter_, grid_, settings_.resolution.phi / 32);
  }
}

void ShadowVolume::fill(const frame::FrameInputs& inputs) {
  inputs.timer.time("populate", [&] { fill_unscanned(inputs, !fused_scan_); });
  inputs.timer.time("scan", [&] {
    if (fused_scan_) fused_scan_->run(grid_);
    if (or_scan_) or_scan_->run(grid_);
    if (mip_scan_) mip_scan_->run(grid_);
  });
}

std::map<std::string, std::int64_t> ShadowVolume::bytes() const {
  std::map<std::string, std::int64_t> bytes = {{"grid", grid_.bits().bytes()},
                                               {"light_rays", grid_.first_shadowed().bytes()}};
  if (populate_screen_space_) bytes["crossings"] = populate_screen_space_->bytes();
  if (mip_scan_) bytes["mip_chain"] = mip_scan_->bytes();
  return bytes;
}

}  // namespace airlight::epipolar
