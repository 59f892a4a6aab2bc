#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "quality/traced.h"
#include "scene/scene.h"

namespace airlight::quality {

/// What there is to say of a truth.
struct TruthFigures {
  double bound = 0.0;              ///< of its own rrmse
  double ms = 0.0;                 ///< of tracing and integrating
  double shadows_per_pixel = 0.0;  ///< triangles that hide a part of a view ray; all lights together
  double lit_runs_per_pixel = 0.0;
  double mean_airlight = 0.0;  ///< over pixels and channels [W/(m² sr)]
};

/// What a view's images are judged by: the exact reference, all lights together.
struct Truth {
  std::vector<glm::vec3> airlight;             ///< RGB [W/(m² sr)]
  std::vector<float> distance;                 ///< along the view ray [m]; 0 where nothing is hit
  std::vector<std::vector<float>> visibility;  ///< of surfaces, for each light: 0 or 1
  TruthFigures figures;
};

Truth trace_truth(SharedReference& reference, const scene::View& view);

}  // namespace airlight::quality
