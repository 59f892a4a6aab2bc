#pragma once

#include "scene/scene.h"

namespace airlight::frame {

/// The optical depth [1] from which on single precision rounds what is left of light to 0, whatever it is
/// multiplied by afterwards: e^−105 is less than a fifth of the least number above 0.
inline constexpr double k_deepest_light = 105.0;

/// How much of the medium each path from the light over some point to the eye has to pass at least [m].
double shortest_path(const scene::View& view, const scene::Light& light);

/// Whether a light may add to an image: never wrongly "no". Where the answer is "no", what methods would
/// compute is 0: nothing that the image shows lies within the spot's cone, or within the light's range, or
/// all that is seen is k_deepest_light away from it, in the channel in which it is least.
bool may_reach(const scene::View& view, const scene::Light& light);

}  // namespace airlight::frame
