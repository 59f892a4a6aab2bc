#pragma once

#include <span>

#include "scene/scene.h"

namespace airlight::scene {

/// Ambient radiance [W/(m² sr)] that suits a scene: a rough stand-in for light that is reflected or scattered
/// more than once.
///
/// It is ρ/π · Φ e^(−σ_a d)/A: all that its lights radiate, Φ, spread evenly over its box, of area A, and
/// reflected once by its mean colour ρ, as the ambient term of progressive radiosity begins (Cohen, Chen,
/// Wallace, Greenberg, "A Progressive Refinement Approach to Fast Radiosity Image Generation", SIGGRAPH 1988,
/// section 5). Scattering spreads light and takes none; absorption takes some on the way d, half the box's
/// diagonal. Of a sun Φ is what falls on the box. Colours are weighted by area, those of textures by their
/// texels.
/// @returns 0 of a scene without surfaces
glm::vec3 fitted_ambient(const Geometry& geometry, std::span<const Light> lights, const Medium& medium);

}  // namespace airlight::scene
