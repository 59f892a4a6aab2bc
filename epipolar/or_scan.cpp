#include "epipolar/or_scan.h"

#include "spirv/epipolar/or_scan_comp.h"

namespace airlight::epipolar {

OrScan::OrScan(const Resolution& resolution)
    : program_(gpu::Pipeline::compute(k_or_scan_comp, resolution_constants(resolution))) {}

void OrScan::run(const Grid& grid) const {
  dispatch_planes(program_, grid, grid.resolution().phi / 128);
}

}  // namespace airlight::epipolar
