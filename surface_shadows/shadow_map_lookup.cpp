#include "surface_shadows/shadow_map_lookup.h"

#include "frame/blocks.h"
#include "frame/shadow_map.h"

#include "spirv/surface_shadows/shadow_map_lookup_frag.h"

namespace airlight::surface_shadows {

void ShadowMapLookup::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  const gpu::Texture& shadow_map = inputs.shadow_map(0.0);
  const bool is_plane = inputs.shadow_map_is_plane();
  auto& pass = passes_[is_plane ? 1 : 0];
  if (!pass) pass.emplace(k_shadow_map_lookup_frag, std::array{gpu::Constant(0, is_plane ? 1 : 0)});
  inputs.timer.time("surface_query", [&] {
    inputs.surfaces.bind_sampler(shaders::k_surface_unit);
    shadow_map.bind_sampler(shaders::k_shadow_map_unit);
    pass->run({visibility});
  });
}

frame::SurfaceMethod shadow_map_method() {
  return frame::describe<frame::SurfaceShadow, ShadowMapLookupOptions>(
      "shadow-map", "one look-up of the shadow cube a pixel", {}, {},
      [](const gpu::Context&, const ShadowMapLookupOptions&) { return std::make_unique<ShadowMapLookup>(); });
}

}  // namespace airlight::surface_shadows
