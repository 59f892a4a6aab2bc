#include "epipolar/fused_scan.h"

#include <bit>

#include "spirv/epipolar/fused_scan_comp.h"

namespace airlight::epipolar {
namespace {

gpu::Pipeline load(const Resolution& resolution) {
  const auto grid = resolution_constants(resolution);
  const auto digits =
      static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint32_t>(resolution.alpha)));
  return gpu::Pipeline::compute(k_fused_scan_comp,
                                std::array{grid[0], grid[1], grid[2], gpu::Constant(3, digits)});
}

}  // namespace

FusedScan::FusedScan(const Resolution& resolution) : program_(load(resolution)) {}

void FusedScan::run(const Grid& grid) const {
  grid.bits().clear();
  dispatch_planes(program_, grid, grid.resolution().phi / 128);
}

}  // namespace airlight::epipolar
