#pragma once

#include "gpu/pipeline.h"

namespace airlight::frame {

/// The fixed state of passes that order surfaces by depth. Depth runs from 1 (near) to 0 (infinity): near / z
/// keeps a relative precision of 2^-24 at any distance. What is nearer than the near plane is kept, at its
/// depth: an occluder must not vanish. Row 0 is at the top.
inline const gpu::FixedState k_reversed_depth = {.depth_test = gpu::Compare::greater,
                                                 .depth_clamp = true,
                                                 .upper_left_origin = true,
                                                 .zero_to_one_depth = true};

}  // namespace airlight::frame
