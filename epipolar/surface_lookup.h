#pragma once

#include <array>
#include <optional>

#include "epipolar/volume.h"
#include "frame/method.h"
#include "frame/screen_pass.h"

namespace airlight::epipolar {

/// `vsv` for surfaces: a surface is lit where one bit of a voxelized shadow volume of its own says so.
/// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, section 2.2.3 and Fig. 7. A way to look at the
/// volume rather than a way to shadow surfaces: its edges are as coarse as the cells, and they move with the
/// eye.
///
/// Deviation: the paper queries "the voxel containing each fragment", which the surface darkens itself. Here
/// it is the last voxel on the same light ray that the surface's own plane leaves alone, and a surface that
/// faces away from the light is dark without being asked.
class SurfaceLookup : public frame::SurfaceShadow {
 public:
  /// @throws scene::Error as Grid.
  SurfaceLookup(const gpu::Context& context, const VolumeOptions& options);

  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override;
  std::map<std::string, std::int64_t> bytes() const override { return volume_.bytes(); }

  const ShadowVolume& volume() const { return volume_; }

 private:
  ShadowVolume volume_;
  VolumeOptions options_;
  std::array<std::optional<frame::ScreenPass>, 2> passes_;  ///< by: the shadow map is on a plane
};

frame::SurfaceMethod surface_lookup_method();

}  // namespace airlight::epipolar
