#include "surface_shadows/occluders.h"

#include <algorithm>
#include <cmath>

#include "frame/blocks.h"

#include "spirv/surface_shadows/occluders_comp.h"

namespace airlight::surface_shadows {

Occluders::Occluders() : program_(gpu::Pipeline::compute(k_occluders_comp)) {}

void Occluders::build(const frame::FrameInputs& inputs) {
  if (scene_ != inputs.scene.id()) {
    const std::int64_t bytes = std::int64_t{3 * sizeof(glm::vec4)} * inputs.scene.triangle_count();
    gpu::require_storage_block(inputs.context.limits(), bytes, "the model's triangles", k_storage_remedy);
    corners_ = gpu::Buffer(bytes);
    corner_texels_ = {inputs.context.limits(), corners_, gpu::Format::rgba32f, "the model's triangles"};
    scene_ = inputs.scene.id();
    count_ = inputs.scene.triangle_count();
  }
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
