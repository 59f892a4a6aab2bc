#pragma once

#include "frame/blocks.h"

namespace airlight::shaders {
#include "epipolar/change_tree.glsl"
#include "epipolar/conservative.glsl"
#include "epipolar/grid.glsl"
static_assert(sizeof(EpipolarBlock) == 80, "must match std140");
}  // namespace airlight::shaders
