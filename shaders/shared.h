// The C++ side of the shader functions: include this before a *.glsl file, inside namespace
// airlight::shaders.
#pragma once

#include <concepts>
#include <cstdint>

#include <glm/glm.hpp>

#define AIRLIGHT_SHARED_GLSL  // keeps shaders/shared.glsl, the GLSL side, out
#define IN(type) const type&
#define OUT(type) type&
#define INOUT(type) type&
#define CONST inline constexpr
#define FUNCTION inline
#define PRECISE

namespace airlight::shaders {

using uint = std::uint32_t;
using glm::abs, glm::ceil, glm::clamp, glm::cross, glm::dot, glm::exp, glm::floor, glm::length, glm::log,
    glm::log2, glm::max, glm::min, glm::mix, glm::normalize, glm::sqrt;
using glm::dvec3, glm::ivec2, glm::ivec3, glm::uvec2, glm::uvec3, glm::uvec4, glm::vec2, glm::vec3, glm::vec4;

/// A number that knows what it counts: in GLSL a float, here a type of its own that has the operations that
/// mean something, so that what mixes two of them up does not compile. Laid out as the number is.
template <class Number, class Unit>
class Quantity {
 public:
  Quantity() = default;
  explicit constexpr Quantity(Number value) : value_(value) {}
  explicit constexpr operator Number() const { return value_; }
  explicit constexpr operator double() const requires std::same_as<Number, float> {
    return static_cast<double>(value_);
  }
  /// The index of a cell.
  explicit constexpr operator uint() const requires Unit::is_counted { return static_cast<uint>(value_); }

  constexpr Quantity operator-() const { return Quantity(-value_); }
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity(a.value_ + b.value_); }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity(a.value_ - b.value_); }
  constexpr Quantity& operator+=(Quantity b) { return *this = *this + b; }
  constexpr Quantity& operator-=(Quantity b) { return *this = *this - b; }

  // Multiples and ratios.
  friend constexpr Quantity operator*(Quantity a, Number b) requires Unit::has_multiples {
    return Quantity(a.value_ * b);
  }
  friend constexpr Quantity operator*(Number a, Quantity b) requires Unit::has_multiples {
    return Quantity(a * b.value_);
  }
  friend constexpr Quantity operator/(Quantity a, Number b) requires Unit::has_multiples {
    return Quantity(a.value_ / b);
  }
  friend constexpr Number operator/(Quantity a, Quantity b) requires Unit::has_multiples {
    return a.value_ / b.value_;
  }

  friend constexpr bool operator==(Quantity a, Quantity b) { return a.value_ == b.value_; }
  friend constexpr bool operator<(Quantity a, Quantity b) { return a.value_ < b.value_; }
  friend constexpr bool operator>(Quantity a, Quantity b) { return a.value_ > b.value_; }
  friend constexpr bool operator<=(Quantity a, Quantity b) { return a.value_ <= b.value_; }
  friend constexpr bool operator>=(Quantity a, Quantity b) { return a.value_ >= b.value_; }
  friend constexpr Quantity min(Quantity a, Quantity b) { return b < a ? b : a; }
  friend constexpr Quantity max(Quantity a, Quantity b) { return a < b ? b : a; }
  friend constexpr Quantity clamp(Quantity a, Quantity lower, Quantity upper) {
    return min(max(a, lower), upper);
  }
  friend Quantity floor(Quantity a) requires Unit::is_counted { return Quantity(floor(a.value_)); }

  /// For messages of tests.
  template <class Stream>
  friend Stream& operator<<(Stream& stream, Quantity a) {
    stream << a.value_;
    return stream;
  }

 private:
  Number value_;
};

struct Radians {
  static constexpr bool has_multiples = true, is_counted = false;
};
struct OrderOfAngle {
  static constexpr bool has_multiples = false, is_counted = false;
};
struct CellsOfAxis {
  static constexpr bool has_multiples = true, is_counted = true;
};

// What they stand for: shared.glsl.
using Angle = Quantity<float, Radians>;
using Order = Quantity<float, OrderOfAngle>;
using Cell = Quantity<float, CellsOfAxis>;

}  // namespace airlight::shaders
