#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace airlight::quality {

/// Whether no pixel is above k_least (truth.h), where single precision ends.
bool is_black(const std::vector<glm::vec3>& radiance);

/// Why an image of the view is black, as the rest of a sentence: a light of no intensity, fog that lets
/// nothing through, a range that ends before what is seen or a spot that looks away from it, or a closed part
/// of the scene that holds the light and not the eye, or the eye and not the light. Where none of these can
/// be proved, that whatever is seen is dark by itself.
/// @param geometry at rest
std::string why_black(const scene::Geometry& geometry, const scene::View& view);

}  // namespace airlight::quality
