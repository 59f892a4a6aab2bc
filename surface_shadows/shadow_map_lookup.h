#pragma once

#include "frame/methods.h"
#include "gpu/pipeline.h"

namespace airlight::surface_shadows {

/// `shadow-map`: one look-up of the shadow cube a pixel, nearest texel, receiver plane as bias.
/// Based on: Williams, "Casting Curved Shadows on Curved Surfaces", SIGGRAPH 1978; the receiver plane after
/// Schüler, "High Quality Shadow Mapping", ShaderX4, 2006.
class ShadowMapLookup : public frame::SurfaceShadow {
 public:
  ShadowMapLookup();
  bool needs_shadow_map() const override { return true; }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override;

 private:
  gpu::Pipeline program_;
};

}  // namespace airlight::surface_shadows
