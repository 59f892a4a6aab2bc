#include "epipolar/populate_scan.h"

#include <algorithm>
#include <bit>

#include "spirv/epipolar/populate_scan_comp.h"

namespace airlight::epipolar {
namespace {

gpu::Program load(const Resolution& resolution) {
  const auto grid = resolution_constants(resolution);
  const auto digits =
      static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint32_t>(resolution.alpha)));
  return gpu::Program::compute(k_populate_scan_comp,
                               std::array{grid[0], grid[1], grid[2], gpu::Constant(3, std::max(digits, 3u))});
}

}  // namespace

PopulateScan::PopulateScan(const Resolution& resolution) : program_(load(resolution)) {}

void PopulateScan::run(const Grid& grid, const frame::ShadowMap& shadow_map) const {
  shadow_map.depth().bind_sampler(0);
  const Resolution& n = grid.resolution();
  program_.dispatch({n.phi / 32, n.theta, 1}, {16, 4, 1});
}

}  // namespace airlight::epipolar
