#include "surface_shadows/shadow_map_lookup.h"

#include "frame/shadow_map.h"

#include "spirv/surface_shadows/shadow_map_lookup_comp.h"

namespace airlight::surface_shadows {

ShadowMapLookup::ShadowMapLookup() : program_(gpu::Pipeline::compute(k_shadow_map_lookup_comp)) {}

void ShadowMapLookup::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  inputs.timer.time("surface_query", [&] {
    inputs.surfaces.bind_sampler(0);
    inputs.shadow_map->depth().bind_sampler(1);
    visibility.bind_image(0);
    program_.dispatch({inputs.view.size, 1});
  });
}

}  // namespace airlight::surface_shadows
