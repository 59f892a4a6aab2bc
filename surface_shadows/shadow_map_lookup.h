#pragma once

#include <array>
#include <optional>

#include "frame/method.h"
#include "frame/screen_pass.h"

namespace airlight::surface_shadows {

/// `shadow-map`: one look-up of the shadow cube a pixel, nearest texel, receiver plane as bias.
/// Based on: Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978; the receiver plane after
/// Schüler, "High Quality Shadow Mapping", ShaderX4, 2006.
class ShadowMapLookup : public frame::SurfaceShadow {
 public:
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override;

 private:
  std::array<std::optional<frame::ScreenPass>, 2> passes_;  ///< by: the map is on a plane
};

struct ShadowMapLookupOptions {
  bool needs_shadow_map() const { return true; }
};

frame::SurfaceMethod shadow_map_method();

}  // namespace airlight::surface_shadows
