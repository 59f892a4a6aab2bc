#pragma once

#include <array>
#include <cstddef>

#include <glm/glm.hpp>

namespace airlight::reference {

/// A sum without any rounding, for the sign of a volume that doubles cannot tell from 0.
///
/// It is held as doubles of growing magnitude whose bits do not overlap, so that the last of them has the
/// sum's sign (Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997).
class ExactSum {
 public:
  /// Volumes that one sum can take.
  static constexpr std::size_t k_volumes = 4;

  /// Adds `sign` · det(x, y, z).
  ///
  /// Exact where neither overflow nor underflow comes in its way: where the values are below 2⁶⁴, and those
  /// of `z`, which may have all the digits of a double, multiples of 2⁻²⁰⁰. Single precision is made of
  /// multiples of 2⁻¹⁴⁹.
  /// @param sign 1 or −1
  void add_volume(const glm::vec3& x, const glm::vec3& y, const glm::dvec3& z, int sign = 1);

  /// −1, 0 or 1.
  int sign() const;

 private:
  void add(double value);
  static constexpr std::size_t k_values_per_volume = 12;  ///< six products of three, each of two doubles
  std::array<double, k_values_per_volume * k_volumes> parts_;
  std::size_t count_ = 0;
};

}  // namespace airlight::reference
