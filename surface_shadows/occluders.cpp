#include "surface_shadows/occluders.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "frame/blocks.h"

#include "spirv/surface_shadows/occluders_comp.h"

namespace airlight::surface_shadows {

Occluders::Occluders(Culling culling)
    : culling_(culling),
      program_(gpu::Pipeline::compute(
          k_occluders_comp, std::array{gpu::Constant(0, culling == Culling::automatic ? 1u : 0u)})) {}

void Occluders::load(const frame::FrameInputs& inputs) {
  const gpu::Limits& limits = inputs.context.limits();
  const std::int64_t bytes = std::int64_t{3 * sizeof(glm::vec4)} * inputs.scene.triangle_count();
  gpu::require_storage_block(limits, bytes, "the model's triangles", k_storage_remedy);
  corners_ = gpu::Buffer(bytes);
  corner_texels_ = {limits, corners_, gpu::Format::rgba32f, "the model's triangles"};
  scene_ = inputs.scene.id();
  count_ = inputs.scene.triangle_count();
  if (culling_ == Culling::none) return;

  const scene::Components& components = inputs.components();
  const std::vector<scene::Box> boxes = scene::boxes_of(components, inputs.geometry());
  std::vector<std::uint32_t> number(components.count, 0);
  boxes_.clear();
  for (std::size_t i = 0; i < components.count; ++i) {
    if (!components.has_two_sides[i]) continue;
    boxes_.push_back(boxes[i]);
    number[i] = static_cast<std::uint32_t>(boxes_.size());
  }
  std::vector<std::uint32_t> parts;
  parts.reserve(count_);
  for (const std::uint32_t triangle : inputs.scene.order())
    parts.push_back(number[components.of_triangle[triangle]]);
  parts_ = gpu::Buffer::from(std::span<const std::uint32_t>(parts));
  is_culled_ = gpu::Buffer(static_cast<std::int64_t>(sizeof(std::uint32_t) * (boxes_.size() + 1)));
  part_texels_ = {limits, parts_, gpu::Format::r32ui, "the model's triangles"};
  is_culled_texels_ = {limits, is_culled_, gpu::Format::r32ui, "the model's parts"};
}

void Occluders::cull_parts(const frame::FrameInputs& inputs) const {
  const glm::dvec3 eye = inputs.view.camera.eye;
  const scene::Light& light = inputs.light();
  // More than the roundings of positions relative to the light.
  const double margin = 1e-6 * static_cast<double>(reach_ / scale_);
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

void Occluders::build(const frame::FrameInputs& inputs) {
  if (scene_ != inputs.scene.id()) load(inputs);
  const frame::LightOrigin origin = inputs.resources.origin();
  const double reach =
      count_ == 0 ? 0.0
                  : scene::reach_from(glm::dvec3(origin.high) + glm::dvec3(origin.low), inputs.scene.box());
  // A normal, a product of two lengths, is squared on the way to unit length: 2^80. Products of three that
  // are flushed to 0 are of lengths 10⁻¹⁸ of the scene's.
  constexpr int k_exponent = 20, k_most = 100;
  const int exponent = reach > 0.0 ? std::clamp(k_exponent - 1 - std::ilogb(reach), -k_most, k_most) : 0;
  scale_ = std::ldexp(1.0f, exponent);
  reach_ = static_cast<float>(std::ldexp(1.00001 * reach, exponent));
  if (count_ == 0) return;

  if (culling_ == Culling::automatic) {
    cull_parts(inputs);
    part_texels_.bind_sampler(shaders::k_parts_unit);
    is_culled_texels_.bind_sampler(shaders::k_is_culled_unit);
  }
  inputs.scene.bind_samplers();
  corners_.bind_storage(shaders::k_occluders_storage);
  program_.set(0, origin.high);
  program_.set(1, origin.low);
  program_.set(2, count_);
  program_.set(3, scale_);
  program_.dispatch({count_, 1, 1});
}

void Occluders::bind(const frame::FrameInputs& inputs) const {
  corner_texels_.bind_sampler(shaders::k_occluders_unit);
  inputs.triangle_planes().bind_sampler(shaders::k_triangle_planes_unit);
}

}  // namespace airlight::surface_shadows
