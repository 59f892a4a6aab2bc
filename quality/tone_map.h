#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::quality {

/// What a display with Rec. 709 primaries shows of exposed radiance, both linear.
///
/// `none` clamps. `reinhard`: L/(1 + L) of the luminance L, colours kept (Reinhard, Stark, Shirley, Ferwerda,
/// "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equation 3). `aces`: Narkowicz's fit,
/// "ACES Filmic Tone Mapping Curve", 2016, of each channel by itself. `agx`: Sobotka's AgX, 2022, by the
/// matrices and the polynomial (of degree 6) of Wrensch, "Minimal AgX Implementation", 2023.
/// @param radiance not negative, times the exposure
/// @returns within [0, 1]
glm::vec3 tone_mapped(scene::ToneMap tone_map, glm::vec3 radiance);

}  // namespace airlight::quality
