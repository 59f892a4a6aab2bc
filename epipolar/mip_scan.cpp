#include "epipolar/mip_scan.h"

#include <algorithm>

#include "epipolar/space_math.h"

#include "spirv/epipolar/mip_scan_down_comp.h"
#include "spirv/epipolar/mip_scan_up_comp.h"

namespace airlight::epipolar {

MipScan::MipScan(const gpu::Limits& limits, const Grid& grid) {
  const Resolution& n = grid.resolution();
  levels_.push_back({static_cast<std::uint32_t>(n.alpha), 0});
  while (levels_.back().size > 1) {
    const std::uint32_t size = (levels_.back().size + 1) / 2;
    levels_.push_back({size, chain_size_});
    chain_size_ += size;
  }
  int planes = 0;
  for (const Window& window : grid.windows()) planes = std::max(planes, window.planes);
  chain_ = gpu::Buffer(std::int64_t{chain_size_} * planes * n.phi / 8);
  chain_texels_ = {limits, chain_, gpu::Format::rgba32ui, "the mip chain"};

  const auto load = [&](std::uint32_t fine_is_grid) {
    const auto grid_constants = resolution_constants(n);
    const std::array constants = {grid_constants[0], grid_constants[1], grid_constants[2],
                                  gpu::Constant(3, fine_is_grid)};
    return Programs{gpu::Pipeline::compute(k_mip_scan_up_comp, constants),
                    gpu::Pipeline::compute(k_mip_scan_down_comp, constants)};
  };
  of_grid_ = load(1);
  of_chain_ = load(0);
}

void MipScan::pass(const gpu::Pipeline& program, std::size_t fine, std::uint32_t entries, const Grid& grid,
                   const Window& window) const {
  // The uniforms of shaders/epipolar/mip_scan.glsl.
  set_window(program, window);
  program.set(1, glm::uvec4(levels_[fine].size, levels_[fine].start, levels_[fine + 1].size,
                            levels_[fine + 1].start));
  program.set(2, chain_size_);
  const auto texels = static_cast<std::uint32_t>(grid.resolution().phi / 128);
  program.dispatch({entries * texels, window.planes, 1});
}

void MipScan::run(const Grid& grid) const {
  chain_.bind_storage(shaders::k_scratch_storage);
  chain_texels_.bind_sampler(shaders::k_scratch_unit);
  for (const Window& window : grid.windows()) {
    grid.bind_window(window);
    for (std::size_t fine = 0; fine + 1 < levels_.size(); ++fine)
      pass((fine == 0 ? of_grid_ : of_chain_).up, fine, levels_[fine + 1].size, grid, window);
    for (std::size_t fine = levels_.size() - 1; fine-- > 0;)
      pass((fine == 0 ? of_grid_ : of_chain_).down, fine, levels_[fine].size, grid, window);
  }
}

}  // namespace airlight::epipolar
