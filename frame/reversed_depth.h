#pragma once

#include "gpu/pipeline.h"

namespace airlight::frame {

/// The fixed state of passes that order surfaces by depth. Depth runs from 1 (near) to 0 (infinity): near / z
/// keeps a relative precision of 2^-24 at any distance. Nothing that is drawn is nearer than the near plane
/// (near_depth), which cuts off only what lies beside or behind the apex; with depth clamping instead of it,
/// NVIDIA's driver drops a triangle that has a corner beside the apex, in the plane of no depth. Row 0 is at
/// the top.
inline const gpu::FixedState k_reversed_depth = {
    .depth_test = gpu::Compare::greater, .upper_left_origin = true, .zero_to_one_depth = true};

}  // namespace airlight::frame
