#pragma once

#include "frame/frame.h"
#include "quality/metrics.h"
#include "quality/truth.h"

namespace airlight::quality {

/// How far a frame is from the truth.
struct Errors {
  AirlightError airlight{};
  double flip = 0.0;                ///< the airlight's hdr_flip; NaN where the truth is dark
  SameSurfaceError same_surface{};  ///< the airlight's
  SurfaceError surface{};           ///< summed over the lights that were not skipped
};

/// @param truth of the airlight, and that of the surfaces (Truth::shown_by)
Errors judge(const frame::FrameImages& images, const Truth& truth, const Truth& of_surfaces);

/// Of the airlight: see `flicker`.
ErrorImage error_image(const frame::FrameImages& images, const Truth& truth);

}  // namespace airlight::quality
