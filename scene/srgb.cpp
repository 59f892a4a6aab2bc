#include "scene/srgb.h"

#include <cmath>

namespace airlight::scene {

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

const std::array<double, 256>& linear_of_bytes() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i)
      linear[i] = linear_from_srgb(static_cast<double>(i) / 255.0);
    return linear;
  }();
  return table;
}

SrgbEncoder::SrgbEncoder() {
  for (std::size_t i = 0; i <= k_steps; ++i)
    table_[i] = static_cast<std::uint8_t>(
        std::lround(255.0 * srgb_from_linear(static_cast<double>(i) / static_cast<double>(k_steps))));
}

}  // namespace airlight::scene
