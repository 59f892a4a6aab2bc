#include "frame/none.h"

#include <epoxy/gl.h>

namespace airlight::frame {

void NoShadow::query(const FrameInputs& inputs, const gpu::Texture& visibility) {
  inputs.timer.time("surface_query", [&] {
    const float lit = 1.0f;
    glClearTexImage(visibility.name(), 0, GL_RED, GL_FLOAT, &lit);
  });
}

SurfaceMethod no_shadow_method() {
  return describe<SurfaceShadow, NoOptions>(
      "none", "no shadow: every surface is lit", {.is_none = true}, {},
      [](const gpu::Context&, const NoOptions&) { return std::make_unique<NoShadow>(); });
}

void NoAirlight::integrate(const FrameInputs&, const gpu::Texture& radiance) {
  radiance.clear();
}

AirlightMethod no_airlight_method() {
  return describe<Airlight, NoOptions>(
      "none", "no airlight", {.is_none = true}, {},
      [](const gpu::Context&, const NoOptions&) { return std::make_unique<NoAirlight>(); });
}

}  // namespace airlight::frame
