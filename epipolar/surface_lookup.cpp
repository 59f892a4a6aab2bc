#include "epipolar/surface_lookup.h"

#include <array>

#include "spirv/epipolar/surface_lookup_frag.h"

namespace airlight::epipolar {
namespace {

frame::ScreenPass make_pass(const ShadowVolume& volume, bool whole_voxels, bool on_plane) {
  const auto grid = volume.reader_constants();
  return frame::ScreenPass(k_surface_lookup_frag, std::array{grid[0], grid[1], grid[2], grid[3],
                                                             gpu::Constant(3, whole_voxels ? 1 : 0),
                                                             gpu::Constant(4, on_plane ? 1 : 0)});
}

}  // namespace

SurfaceLookup::SurfaceLookup(const gpu::Context& context, const VolumeOptions& options)
    : volume_(context.limits(), options), options_(options) {}

void SurfaceLookup::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  volume_.find_ranges(inputs);
  volume_.fill(inputs);
  auto& pass = passes_[inputs.shadow_map_is_plane() ? 1 : 0];
  if (!pass)
    pass = make_pass(volume_, options_.populate == Populate::conservative, inputs.shadow_map_is_plane());
  inputs.timer.time("surface_query", [&] {
    inputs.surfaces.bind_sampler(shaders::k_surface_unit);
    pass->run({visibility});
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
