#include "epipolar/surface_lookup.h"

#include <array>

#include "spirv/epipolar/surface_lookup_comp.h"

namespace airlight::epipolar {
namespace {

gpu::Pipeline make_program(const VolumeOptions& options) {
  const auto grid = resolution_constants(options.resolution);
  const bool whole_voxels = options.populate == Populate::conservative;
  return gpu::Pipeline::compute(
      k_surface_lookup_comp, std::array{grid[0], grid[1], grid[2], gpu::Constant(3, whole_voxels ? 1 : 0)});
}

}  // namespace

SurfaceLookup::SurfaceLookup(const gpu::Context& context, const VolumeOptions& options)
    : volume_(context.limits(), options), program_(make_program(options)) {}

void SurfaceLookup::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  volume_.find_ranges(inputs);
  volume_.fill(inputs);
  inputs.timer.time("surface_query", [&] {
    inputs.surfaces.bind_sampler(shaders::k_surface_unit);
    visibility.bind_image(shaders::k_output_image);
    program_.dispatch({inputs.view.size, 1});
  });
}

frame::SurfaceMethod surface_lookup_method() {
  return frame::describe<frame::SurfaceShadow, VolumeOptions>(
      "vsv", "one bit of an epipolar voxelized shadow volume a pixel: to look at the volume", {},
      volume_options(), [](const gpu::Context& context, const VolumeOptions& options) {
        return std::make_unique<SurfaceLookup>(context, options);
      });
}

}  // namespace airlight::epipolar
