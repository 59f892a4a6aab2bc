#include "epipolar/surface_lookup.h"

#include <array>

#include "spirv/epipolar/surface_lookup_comp.h"

namespace airlight::epipolar {
namespace {

gpu::Pipeline make_program(const VolumeSettings& volume) {
  const auto grid = resolution_constants(volume.resolution);
  const bool whole_voxels = volume.populate == Populate::conservative;
  return gpu::Pipeline::compute(
      k_surface_lookup_comp, std::array{grid[0], grid[1], grid[2], gpu::Constant(3, whole_voxels ? 1 : 0)});
}

}  // namespace

SurfaceLookup::SurfaceLookup(const gpu::Context& context, const VolumeSettings& volume)
    : volume_(context.limits(), volume), program_(make_program(volume)) {}

void SurfaceLookup::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  volume_.find_ranges(inputs);
  volume_.fill(inputs);
  inputs.timer.time("surface_query", [&] {
    inputs.surfaces.bind_sampler(0);
    visibility.bind_image(0);
    program_.dispatch({inputs.view.size, 1});
  });
}

}  // namespace airlight::epipolar
