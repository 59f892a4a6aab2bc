#pragma once

#include "frame/view_block.h"

namespace airlight::shaders {
#include "epipolar/grid.glsl"
static_assert(sizeof(EpipolarBlock) == 48, "must match std140");
}  // namespace airlight::shaders
