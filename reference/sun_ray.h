#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "reference/light_plane.h"

namespace airlight::reference {

/// One view ray in the half-plane that it spans with a sun. All vectors are relative to the eye.
///
/// A point of the half-plane at x along w and y along q casts its shadow along −l on the view ray's point
/// t = x + y cot α; only what lies on the sun's side, y < 0, does. The scattering angle is α all along. The
/// medium's path from the sun to the ray's point t and on to the eye is `path` + `slope` · (t − `from`) long:
/// `slope` is 0 where the ray leaves a layer as steeply as the sun's light comes in, and less beyond.
struct SunRay : LightPlane {
  double from, to;  ///< what lies in the medium [m]; `to` is infinite where it has no end
  double path;      ///< of the sun's light in the medium to `from` [m]
  double slope;     ///< at least 1 of an endless ray

  /// The distance at the fraction s ∈ [0, 1] of the way.
  double t(double s) const { return from + s * (to - from); }

  /// The last point in the medium, or infinity, in each axis that the ray moves along.
  glm::dvec3 end() const;
};

/// @param l     unit direction to the sun, above the horizon where the medium has a top
/// @param eye_y height of the eye over the medium's top [m]; none for a medium without a top, in which the
///              sun's light has no path
/// The others are those of `make_view_ray`.
SunRay make_sun_ray(const glm::dvec3& l, const glm::dvec3& direction, const glm::dvec3& right,
                    double distance, double smallest_alpha, std::optional<double> eye_y);

}  // namespace airlight::reference
