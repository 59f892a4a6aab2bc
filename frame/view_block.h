#pragma once

#include "shared.h"

namespace airlight::shaders {
#include "frame/light_texture.glsl"
#include "frame/shadow_cube.glsl"
#include "frame/view.glsl"
static_assert(sizeof(ViewBlock) == 128, "must match std140");
}  // namespace airlight::shaders
