#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

/// Single precision as badly as GLSL 4.50 allows (section 4.7.1), and worse by chance at every step: the
/// shared functions of shaders/, compiled with it, have to keep what they promise. See rough_shaders.h.
namespace airlight::rough {

using Single = float;

class Rough {
 public:
  Rough() = default;
  constexpr Rough(Single value) : value_(value) {}  // NOLINT: as float converts
  explicit constexpr Rough(std::uint32_t value) : value_(static_cast<Single>(value)) {}
  explicit constexpr Rough(int value) : value_(static_cast<Single>(value)) {}
  explicit constexpr operator Single() const { return value_; }
  explicit operator std::uint32_t() const { return static_cast<std::uint32_t>(value_); }

  /// Sums and products: right to a rounding, whose direction is open.
  friend Rough operator+(Rough a, Rough b) { return rounded(a.exact() + b.exact()); }
  friend Rough operator-(Rough a, Rough b) { return rounded(a.exact() - b.exact()); }
  friend Rough operator*(Rough a, Rough b) { return rounded(a.exact() * b.exact()); }
  /// 2.5 ulp.
  friend Rough operator/(Rough a, Rough b) { return off_by(a.exact() / b.exact(), 2); }
  Rough operator-() const { return Rough(-value_); }
  Rough& operator+=(Rough b) { return *this = *this + b; }
  Rough& operator-=(Rough b) { return *this = *this - b; }
  Rough& operator*=(Rough b) { return *this = *this * b; }
  Rough& operator/=(Rough b) { return *this = *this / b; }

  friend constexpr bool operator<(Rough a, Rough b) { return a.value_ < b.value_; }
  friend constexpr bool operator>(Rough a, Rough b) { return a.value_ > b.value_; }
  friend constexpr bool operator<=(Rough a, Rough b) { return a.value_ <= b.value_; }
  friend constexpr bool operator>=(Rough a, Rough b) { return a.value_ >= b.value_; }
  friend constexpr bool operator==(Rough a, Rough b) { return a.value_ == b.value_; }
  friend constexpr bool operator!=(Rough a, Rough b) { return a.value_ != b.value_; }

  /// 1.0 / inversesqrt(), of 2 and 2.5 ulp.
  friend Rough sqrt(Rough a) { return off_by(std::sqrt(a.exact()), 4); }
  friend Rough abs(Rough a) { return Rough(std::abs(a.value_)); }
  friend Rough floor(Rough a) { return Rough(std::floor(a.value_)); }
  friend Rough ceil(Rough a) { return Rough(std::ceil(a.value_)); }
  friend Rough min(Rough a, Rough b) { return b < a ? b : a; }
  friend Rough max(Rough a, Rough b) { return a < b ? b : a; }
  friend Rough clamp(Rough a, Rough lower, Rough upper) { return min(max(a, lower), upper); }

  /// Errors are upwards (1), downwards (−1), or either by chance (0).
  static inline int lean = 0;

 private:
  double exact() const { return static_cast<double>(value_); }

  /// Whether the next result is to be the larger one.
  static bool goes_up() { return lean < 0 ? false : lean > 0 ? true : random() % 2 == 0; }

  static std::uint32_t random() {
    static std::uint32_t state = 1;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
  }

  /// Denormal numbers may be flushed to 0.
  static Rough stored(Single value) {
    const bool is_flushed = std::abs(value) < std::numeric_limits<Single>::min() && random() % 2 == 0;
    return Rough(is_flushed ? Single{0} : value);
  }

  /// The number so many steps farther from 0.
  static Single stepped(Single value, int steps) {
    return std::bit_cast<Single>(std::bit_cast<std::uint32_t>(value) + static_cast<std::uint32_t>(steps));
  }

  /// One of the two numbers about `value`, if it is none itself.
  static Rough rounded(double value) {
    const auto nearest = static_cast<Single>(value);
    const bool is_below = static_cast<double>(nearest) < value;
    if (static_cast<double>(nearest) == value || nearest == 0 || goes_up() != is_below)
      return stored(nearest);
    return stored(stepped(nearest, is_below == (nearest > 0) ? 1 : -1));
  }

  /// The nearest number, or one up to `ulps` beside it; that far as often as nearer.
  static Rough off_by(double value, int ulps) {
    const auto nearest = static_cast<Single>(value);
    if (nearest == 0) return Rough(nearest);
    const int steps =
        random() % 2 == 0 ? ulps : static_cast<int>(random() % static_cast<std::uint32_t>(ulps));
    return stored(stepped(nearest, goes_up() == (nearest > 0) ? steps : -steps));
  }

  Single value_;
};

}  // namespace airlight::rough
