#pragma once

#include "frame/method.h"

namespace airlight::frame {

/// `none` for surfaces: every one is lit.
class NoShadow : public SurfaceShadow {
 public:
  void query(const FrameInputs& inputs, const gpu::Texture& visibility) override;
};

SurfaceMethod no_shadow_method();

/// `none` for the medium: no airlight.
class NoAirlight : public Airlight {
 public:
  void integrate(const FrameInputs& inputs, const gpu::Texture& radiance) override;
};

AirlightMethod no_airlight_method();

}  // namespace airlight::frame
