#include "epipolar/populate_conservative.h"

#include "spirv/epipolar/populate_conservative_comp.h"

namespace airlight::epipolar {

PopulateConservative::PopulateConservative(const Resolution& resolution)
    : triangles_(resolution, k_populate_conservative_comp) {}

void PopulateConservative::run(const Grid& grid, const frame::SceneBuffers& scene,
                               std::span<const std::uint32_t> left_out) {
  grid.first_shadowed().clear(static_cast<std::uint32_t>(grid.resolution().alpha));
  scene.bind_samplers();
  std::uint32_t first = 0;
  for (const std::uint32_t hole : left_out) {
    triangles_.run(first, hole - first);
    first = hole + 1;
  }
  triangles_.run(first, scene.triangle_count() - first);
}

}  // namespace airlight::epipolar
