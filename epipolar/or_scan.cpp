#include "epipolar/or_scan.h"

#include "spirv/epipolar/or_scan_comp.h"

namespace airlight::epipolar {

OrScan::OrScan(const Resolution& resolution)
    : program_(gpu::Program::compute(k_or_scan_comp, resolution_constants(resolution))) {}

void OrScan::run(const Grid& grid) const {
  const Resolution& n = grid.resolution();
  program_.dispatch({n.phi / 128, n.theta, 1}, {4, 4, 1});
}

}  // namespace airlight::epipolar
