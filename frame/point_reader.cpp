#include "frame/point_reader.h"

namespace airlight::frame {

void PointReader::query(const FrameInputs& inputs, const gpu::Texture& visibility) {
  if (inputs.light_index == 0) {
    points_.triangles = inputs.triangles.read<std::uint32_t>();
    const std::vector<std::uint32_t>& order = inputs.scene.order();
    for (std::uint32_t& triangle : points_.triangles)
      if (triangle != 0) triangle = order[triangle - 1] + 1;
    points_.of_light.resize(inputs.view.lights.size());
  }
  points_.of_light[inputs.light_index] = inputs.surface_points().read<glm::vec4>();
  visibility.clear();
}

}  // namespace airlight::frame
