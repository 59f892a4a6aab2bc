#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace airlight::scene {

/// The sRGB transfer function, IEC 61966-2-1: linear [0, 1] to encoded [0, 1].
double srgb_from_linear(double linear);

/// Its inverse.
double linear_from_srgb(double encoded);

/// That of each 8-bit value, for tables.
const std::array<double, 256>& linear_of_bytes();

/// Encodes linear values as 8-bit sRGB, rounded to the nearest, by a table.
class SrgbEncoder {
 public:
  SrgbEncoder();
  std::uint8_t operator()(float linear) const {
    // Clamps what is not a number to 0, too: it is refused elsewhere.
    const float scaled = linear > 0.0f ? (linear < 1.0f ? linear : 1.0f) * static_cast<float>(k_steps) : 0.0f;
    return table_[static_cast<std::size_t>(scaled + 0.5f)];
  }

 private:
  /// The darkest step of sRGB is 1/(255 · 12.92) wide: 20 of these.
  static constexpr std::size_t k_steps = 1 << 16;
  std::array<std::uint8_t, k_steps + 1> table_;
};

}  // namespace airlight::scene
