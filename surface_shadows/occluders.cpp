#include "surface_shadows/occluders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "frame/blocks.h"

#include "spirv/surface_shadows/occluders_comp.h"

namespace airlight::surface_shadows {

LightScale light_scale(const frame::FrameInputs& inputs) {
  const frame::LightOrigin origin = inputs.resources.origin();
  const double reach =
      inputs.scene.triangle_count() == 0
          ? 0.0
          : scene::reach_from(glm::dvec3(origin.high) + glm::dvec3(origin.low), inputs.scene.box());
  // A normal, a product of two lengths, is squared on the way to unit length: 2^80. Products of three that
  // are flushed to 0 are of lengths 10⁻¹⁸ of the scene's.
  constexpr int k_exponent = 20, k_most = 100;
  const int exponent = reach > 0.0 ? std::clamp(k_exponent - 1 - std::ilogb(reach), -k_most, k_most) : 0;
  return {std::ldexp(1.0f, exponent), static_cast<float>(std::ldexp(1.00001 * reach, exponent))};
}

Occluders::Occluders(Culling culling) : culling_(culling) {}

void Occluders::load(const frame::FrameInputs& inputs) {
  const gpu::Limits& limits = inputs.context.limits();
  const std::int64_t bytes = std::int64_t{3 * sizeof(glm::vec4)} * inputs.scene.triangle_count();
  gpu::require_storage_block(limits, bytes, "the model's triangles", k_storage_remedy);
  corners_ = gpu::Buffer(bytes);
  corner_texels_ = {limits, corners_, gpu::Format::rgba32f, "the model's triangles"};
  count_ = inputs.scene.triangle_count();
  const bool is_first = scene_ == 0, culled = std::exchange(culls_, culls(culling_, inputs.scene));
  if (is_first || culled != culls_)
    program_ = gpu::Pipeline::compute(k_occluders_comp, std::array{gpu::Constant(0, culls_ ? 1u : 0u)});
  scene_ = inputs.scene.id();
  if (!culls_) return;

  culled_parts_ = CulledParts(inputs);
  parts_ = gpu::Buffer::from(std::span<const std::uint32_t>(culled_parts_.of_triangle()));
  part_texels_ = {limits, parts_, gpu::Format::r32ui, "the model's triangles"};
}

void Occluders::build(const frame::FrameInputs& inputs) {
  if (scene_ != inputs.scene.id()) load(inputs);
  scale_ = light_scale(inputs);
  if (count_ == 0) return;

  if (culls_) {
    culled_parts_.find(inputs, scale_.margin());
    culled_parts_.bind();
    part_texels_.bind_sampler(shaders::k_parts_unit);
  }
  inputs.scene.bind_samplers();
  corners_.bind_storage(shaders::k_occluders_storage);
  const frame::LightOrigin origin = inputs.resources.origin();
  program_.set(0, origin.high);
  program_.set(1, origin.low);
  program_.set(2, count_);
  program_.set(3, scale_.scale);
  program_.dispatch({count_, 1, 1});
}

void Occluders::bind(const frame::FrameInputs& inputs) const {
  corner_texels_.bind_sampler(shaders::k_occluders_unit);
  inputs.triangle_planes().bind_sampler(shaders::k_triangle_planes_unit);
  if (inputs.scene.transmits()) inputs.scene.attenuations().bind_sampler(shaders::k_attenuations_unit);
}

}  // namespace airlight::surface_shadows
