#include "epipolar/populate_conservative.h"

#include "spirv/epipolar/populate_conservative_comp.h"

namespace airlight::epipolar {

PopulateConservative::PopulateConservative(const Resolution& resolution)
    : triangles_(resolution, k_populate_conservative_comp) {}

void PopulateConservative::run(const Grid& grid, const frame::SceneBuffers& scene) {
  grid.first_shadowed().clear(static_cast<std::uint32_t>(grid.resolution().alpha));
  scene.bind_samplers();
  triangles_.run(0, scene.triangle_count());
}

}  // namespace airlight::epipolar
