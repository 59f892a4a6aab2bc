#include "surface_shadows/culled_parts.h"

#include "frame/blocks.h"

namespace airlight::surface_shadows {

CulledParts::CulledParts(const frame::FrameInputs& inputs) {
  const scene::Components& components = inputs.components();
  const std::vector<scene::Box> boxes = scene::boxes_of(components, inputs.geometry());
  std::vector<std::uint32_t> number(components.count, 0);
  for (std::size_t i = 0; i < components.count; ++i) {
    if (!components.has_two_sides[i]) continue;
    boxes_.push_back(boxes[i]);
    number[i] = static_cast<std::uint32_t>(boxes_.size());
  }
  of_triangle_.reserve(inputs.scene.triangle_count());
  for (const std::uint32_t triangle : inputs.scene.order())
    of_triangle_.push_back(number[components.of_triangle[triangle]]);
  is_culled_ = gpu::Buffer(static_cast<std::int64_t>(sizeof(std::uint32_t) * (boxes_.size() + 1)));
  is_culled_texels_ = {inputs.context.limits(), is_culled_, gpu::Format::r32ui, "the model's parts"};
}

void CulledParts::find(const frame::FrameInputs& inputs, double margin) const {
  const glm::dvec3 eye = inputs.view.camera.eye;
  const scene::Light& light = inputs.light();
  const auto is_outside = [&](const scene::Box& box, glm::dvec3 point) {
    return glm::any(glm::lessThan(point, glm::dvec3(box.lower) - margin)) ||
           glm::any(glm::greaterThan(point, glm::dvec3(box.upper) + margin));
  };
  std::vector<std::uint32_t> is_culled = {0};
  is_culled.reserve(boxes_.size() + 1);
  for (const scene::Box& box : boxes_)
    is_culled.push_back(
        is_outside(box, eye) && (scene::is_sun(light) || is_outside(box, light.position)) ? 1 : 0);
  is_culled_.write(is_culled.data(), is_culled_.bytes());
}

void CulledParts::bind() const {
  is_culled_texels_.bind_sampler(shaders::k_is_culled_unit);
}

}  // namespace airlight::surface_shadows
