#include "surface_shadows/shadow_map_lookup.h"

#include "frame/blocks.h"
#include "frame/shadow_map.h"

#include "spirv/surface_shadows/shadow_map_lookup_frag.h"

namespace airlight::surface_shadows {

ShadowMapLookup::ShadowMapLookup() : pass_(k_shadow_map_lookup_frag) {}

void ShadowMapLookup::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  const frame::ShadowMap& shadow_map = inputs.shadow_map(0.0);
  inputs.timer.time("surface_query", [&] {
    inputs.surfaces.bind_sampler(shaders::k_surface_unit);
    shadow_map.depth().bind_sampler(shaders::k_shadow_map_unit);
    pass_.run({visibility});
  });
}

frame::SurfaceMethod shadow_map_method() {
  return frame::describe<frame::SurfaceShadow, ShadowMapLookupOptions>(
      "shadow-map", "one look-up of the shadow cube a pixel", {}, {},
      [](const gpu::Context&, const ShadowMapLookupOptions&) { return std::make_unique<ShadowMapLookup>(); });
}

}  // namespace airlight::surface_shadows
