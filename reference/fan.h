#pragma once

#include <cmath>

#include "reference/view_ray.h"
#include "reference/visibility.h"

namespace airlight::reference {

/// ψ/2 of neighbouring samples of one view ray, as cosine and sine.
struct HalfAngles {
  alignas(64) double cosine[LightRays::k_count];
  alignas(64) double sine[LightRays::k_count];

  void set(int lane, double psi) {
    cosine[lane] = std::cos(0.5 * psi);
    sine[lane] = std::sin(0.5 * psi);
  }
};

/// The light rays to the samples at these angles.
inline void aim(const ViewRay& ray, const HalfAngles& half, LightRays& out) {
  const double perpendicular = ray.D * ray.sin_alpha;
  for (int i = 0; i < LightRays::k_count; ++i) {
    const double cosine = half.cosine[i] * half.cosine[i] - half.sine[i] * half.sine[i];
    const double sine = 2.0 * half.cosine[i] * half.sine[i];
    out.direction_x[i] = static_cast<float>(ray.w.x * cosine + ray.q.x * sine);  // view_ray.h (1)
    out.direction_y[i] = static_cast<float>(ray.w.y * cosine + ray.q.y * sine);
    out.direction_z[i] = static_cast<float>(ray.w.z * cosine + ray.q.z * sine);
    out.length[i] = static_cast<float>(perpendicular / sine);  // view_ray.h (2)
  }
}

/// Walks along a view ray in equal steps of φ, `LightRays::k_count` samples at a time, without a sine a
/// sample.
class Fan {
 public:
  /// Sample j lies at the fraction (j + `offset`) / `steps` of the range of φ.
  Fan(const ViewRay& ray, int steps, double offset) {
    for (int i = 0; i < LightRays::k_count; ++i) half_.set(i, ray.psi((i + offset) / steps));
    const double advance = 0.5 * ray.phi_d * LightRays::k_count / steps;
    cosine_ = std::cos(advance);
    sine_ = std::sin(advance);
  }

  const HalfAngles& places() const { return half_; }

  /// Moves on to the next `LightRays::k_count` samples. Past the last sample of a view ray the angles mean
  /// nothing.
  void advance() {
    for (int i = 0; i < LightRays::k_count; ++i) {
      const double cosine = half_.cosine[i] * cosine_ + half_.sine[i] * sine_;
      half_.sine[i] = half_.sine[i] * cosine_ - half_.cosine[i] * sine_;
      half_.cosine[i] = cosine;
    }
  }

 private:
  HalfAngles half_;
  double cosine_, sine_;
};

}  // namespace airlight::reference
