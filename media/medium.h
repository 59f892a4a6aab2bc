#pragma once

#include "epipolar/space_math.h"
#include "scene/scene.h"

namespace airlight::shaders {
#include "media/medium.glsl"
#include "media/row_end.glsl"
static_assert(sizeof(MediumBlock) == 48, "must match std140");
}  // namespace airlight::shaders

namespace airlight::media {

/// The uniform block of a view's medium and light. `table_row_step` is left 0.
shaders::MediumBlock medium_block(const scene::View& view);

}  // namespace airlight::media
