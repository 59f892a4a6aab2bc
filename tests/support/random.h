#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <glm/glm.hpp>

namespace airlight::tests {

/// Numbers that are the same in every run and on every machine.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_()) / 4294967296.0; }
  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

  /// In [lower, upper), every power of ten alike; both > 0.
  double logarithmic(double lower, double upper) { return lower * std::pow(upper / lower, uniform()); }

  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }

  glm::dvec3 in_box(double half_side) {
    const double x = uniform(-half_side, half_side), y = uniform(-half_side, half_side);
    return {x, y, uniform(-half_side, half_side)};
  }

  /// A unit vector, every direction alike.
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_box(1.0);
      const double length = glm::length(v);
      if (length > 0.1 && length <= 1.0) return v / length;
    }
  }

 private:
  std::mt19937 engine_;
};

}  // namespace airlight::tests
