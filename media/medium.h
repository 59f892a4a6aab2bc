#pragma once

#include "epipolar/space_math.h"
#include "scene/scene.h"

namespace airlight::shaders {
#include "media/froxels.glsl"
#include "media/layer.glsl"
#include "media/march_steps.glsl"
#include "media/medium.glsl"
#include "media/reach.glsl"
#include "media/row_end.glsl"
#include "media/table_place.glsl"
static_assert(sizeof(FroxelHistoryBlock) == 96, "must match std140");
}  // namespace airlight::shaders

namespace airlight::media {

static_assert(static_cast<unsigned>(scene::PhaseFunction::isotropic) == shaders::k_isotropic);
static_assert(static_cast<unsigned>(scene::PhaseFunction::rayleigh) == shaders::k_rayleigh);
static_assert(static_cast<unsigned>(scene::PhaseFunction::henyey_greenstein) == shaders::k_henyey_greenstein);
static_assert(static_cast<unsigned>(scene::PhaseFunction::hoffman_preetham) == shaders::k_hoffman_preetham);

}  // namespace airlight::media
