#pragma once

#include "reference/sun_ray.h"
#include "reference/visibility.h"

namespace airlight::reference {

/// t of neighbouring samples of one view ray.
struct Distances {
  double t[SunwardRays::k_count];

  void set(int lane, double distance) { t[lane] = distance; }
};

/// The rays to the sun from the samples at these distances.
inline void aim(const SunRay& ray, const Distances& at, SunwardRays& out) {
  for (int i = 0; i < SunwardRays::k_count; ++i) {
    out.origin_x[i] = static_cast<float>(ray.w.x * at.t[i]);
    out.origin_y[i] = static_cast<float>(ray.w.y * at.t[i]);
    out.origin_z[i] = static_cast<float>(ray.w.z * at.t[i]);
  }
}

/// Walks along a view ray in equal steps of t, `SunwardRays::k_count` samples at a time.
class SunSteps {
 public:
  /// Sample j lies at the fraction (j + `offset`) / `steps` of the way.
  SunSteps(const SunRay& ray, int steps, double offset) : ray_(ray), steps_(steps), next_(offset) {
    advance();
  }

  const Distances& places() const { return at_; }

  /// Moves on to the next `SunwardRays::k_count` samples.
  void advance() {
    for (int i = 0; i < SunwardRays::k_count; ++i) at_.set(i, ray_.t((next_ + i) / steps_));
    next_ += SunwardRays::k_count;
  }

 private:
  const SunRay& ray_;
  int steps_;
  double next_;
  Distances at_;
};

}  // namespace airlight::reference
