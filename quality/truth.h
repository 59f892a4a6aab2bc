#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "frame/method.h"
#include "frame/surface_points.h"
#include "quality/metrics.h"
#include "quality/traced.h"
#include "scene/scene.h"

namespace airlight::quality {

/// Methods add up and subtract, in single precision, the airlight of whole view rays. Where less than this
/// part of it is left, an error is the rounding of what is not there.
constexpr double k_dark = 1e-6;

/// The mean of an image whose pixels single precision still holds with all digits where they are a part of
/// k_dark of it, and more [W/(m² sr)].
constexpr double k_least = 1e-30;

/// What there is to say of a truth.
struct TruthFigures {
  double bound = 0.0;              ///< of its own rrmse
  double ms = 0.0;                 ///< of tracing and integrating
  double shadows_per_pixel = 0.0;  ///< triangles that hide a part of a view ray; all lights together
  double lit_runs_per_pixel = 0.0;
  double mean_airlight = 0.0;  ///< over pixels and channels [W/(m² sr)]

  /// Where the mean airlight is not above this, the truth is dark, and nothing is said relative to it:
  /// k_dark of what the same lights and medium would give if nothing stood in them, but at least k_least.
  double floor = 0.0;

  bool is_dark() const { return !(mean_airlight > floor); }
};

/// What a view's images are judged by: the exact reference, all lights together.
struct Truth {
  std::vector<glm::vec3> airlight;        ///< RGB [W/(m² sr)]
  std::vector<float> distance;            ///< along the view ray [m]; 0 where it hits nothing
  std::vector<SurfaceVerdicts> verdicts;  ///< for each light, on the points that frames of the view shade
  TruthFigures figures;
  /// Where light passes triangles, the truth of a scene of which none lets any through: what methods show
  /// that take all for opaque.
  std::shared_ptr<const Truth> opaque = nullptr;

  /// By which a method's image is judged.
  const Truth& shown_by(const frame::Traits& traits) const {
    return opaque && !traits.transmits ? *opaque : *this;
  }
};

/// @param points that frames of the view shade
Truth trace_truth(SharedReference& reference, const scene::View& view, const frame::SurfacePoints& points);

}  // namespace airlight::quality
