#pragma once

#include <cstdint>
#include <optional>

#include "frame/method.h"
#include "frame/methods.h"
#include "media/medium.h"
#include "scene/scene.h"

namespace airlight::media {

/// What shaders are specialised for: whether there is a layer, and whether it is entered from above
/// (shaders/media/layer.glsl).
std::uint32_t layer_of(const scene::Medium& medium, const scene::Light& light, const glm::dvec3& eye);

/// The same: whether a light has a cone and a range (shaders/media/reach.glsl).
std::uint32_t reach_of(const scene::Light& light);

/// Whether the integrand of a lamp's airlight changes much within a step of φ: a lobe of the phase function
/// is narrow, or light reaches not farther than a few steps. Those span, in all, not much more than D; from a
/// lamp that the layer does not hold, no more than the scene either.
bool is_rough(const frame::FrameInputs& inputs, std::uint32_t layer);

/// Epipolar space of a view and a light, for methods without a grid in it.
shaders::EpipolarBlock gridless_space(const scene::View& view, const scene::Light& light);

/// Of a phase function whose lobe is too narrow for steps that follow the integrand.
std::optional<frame::Refusal> narrow_lobe(const scene::Medium& medium);

}  // namespace airlight::media
