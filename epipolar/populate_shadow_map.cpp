#include "epipolar/populate_shadow_map.h"

#include "epipolar/space_math.h"

#include "spirv/epipolar/populate_shadow_map_comp.h"

namespace airlight::epipolar {

PopulateShadowMap::PopulateShadowMap(const Resolution& resolution)
    : program_(gpu::Pipeline::compute(k_populate_shadow_map_comp, resolution_constants(resolution))) {}

void PopulateShadowMap::run(const Grid& grid, const frame::ShadowMap& shadow_map) const {
  shadow_map.depth().bind_sampler(shaders::k_shadow_map_unit);
  const Resolution& n = grid.resolution();
  program_.dispatch({n.phi, (n.theta + 15) / 16, 1});
}

}  // namespace airlight::epipolar
