#include "epipolar/populate_shadow_map.h"

#include "epipolar/space_math.h"

#include "spirv/epipolar/populate_shadow_map_comp.h"

namespace airlight::epipolar {

void PopulateShadowMap::run(const Grid& grid, const frame::FrameInputs& inputs, double reach) {
  inputs.shadow_map(reach).bind_sampler(shaders::k_shadow_map_unit);
  const Resolution& n = grid.resolution();
  auto& program = programs_[inputs.shadow_map_is_plane() ? 1 : 0];
  if (!program) {
    const auto counts = resolution_constants(n);
    const gpu::Constant on_plane(3, inputs.shadow_map_is_plane() ? 1 : 0);
    program = gpu::Pipeline::compute(k_populate_shadow_map_comp,
                                     std::array{counts[0], counts[1], counts[2], on_plane});
  }
  program->dispatch({n.phi, n.theta, 1});
}

}  // namespace airlight::epipolar
