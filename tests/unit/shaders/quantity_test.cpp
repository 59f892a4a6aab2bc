#include <concepts>
#include <type_traits>

#include <gtest/gtest.h>

#include "media/medium.h"
#include "support/rough_shaders.h"

/// What the types of shaders/shared.h are for: what mixes up an angle, the order of an angle and a place in
/// the grid does not compile.
namespace airlight::shaders {
namespace {

template <class A, class B>
concept Mixable = std::constructible_from<A, B> || std::assignable_from<A&, B> || requires(A a, B b) {
  a + b;
} || requires(A a, B b) {
  a < b;
};
template <class A, class B>
concept Multipliable = requires(A a, B b) {
  a* b;
};

static_assert(Mixable<Angle, Angle> && Mixable<Order, Order> && Mixable<Cell, Cell>);
static_assert(!Mixable<Angle, Cell> && !Mixable<Cell, Angle>);
static_assert(!Mixable<Angle, Order> && !Mixable<Order, Angle>);
static_assert(!Mixable<Cell, Order> && !Mixable<Order, Cell>);
static_assert(!Mixable<rough::Angle, rough::Cell> && !Mixable<rough::Order, rough::Angle>);

// A bare number becomes one of them, and one of them a number, only where that is asked for.
static_assert(std::constructible_from<Angle, float> && !std::convertible_to<float, Angle>);
static_assert(std::constructible_from<float, Angle> && !std::convertible_to<Angle, float>);
static_assert(std::constructible_from<uint, Cell> && !std::constructible_from<uint, Angle>);

static_assert(Multipliable<Angle, float> && !Multipliable<Angle, Angle> && !Multipliable<Order, float>);
static_assert(std::same_as<decltype(Angle() / Angle()), float>);

// Functions take what their names say.
static_assert(std::is_invocable_r_v<Cell, decltype(cell_of_phi), PhiCells, Angle>);
static_assert(!std::is_invocable_v<decltype(cell_of_phi), PhiCells, Cell>);
static_assert(!std::is_invocable_v<decltype(cell_of_phi), PhiCells, Order>);
static_assert(!std::is_invocable_v<decltype(phi_of_cell), PhiCells, Angle>);
static_assert(!std::is_invocable_v<decltype(phi_of_cell), PhiCells, float>);
static_assert(!std::is_invocable_v<decltype(theta_of_plane), EpipolarBlock, Angle>);
static_assert(!std::is_invocable_v<decltype(angle_from_order), Angle>);
static_assert(!std::is_invocable_v<decltype(rough::phi_of_cell), rough::PhiCells, rough::Angle>);

// An angle is not its sine.
static_assert(!std::is_invocable_v<decltype(alpha_at), EpipolarBlock, Angle, Angle, float>);
static_assert(!std::is_invocable_v<decltype(phase_function), uint, MediumBlock, Angle>);

// They lie in a uniform block as floats do.
static_assert(sizeof(Angle) == sizeof(float) && alignof(Angle) == alignof(float));
static_assert(std::is_trivially_copyable_v<Angle> && std::is_standard_layout_v<Angle>);

TEST(Quantity, IsReckonedWithLikeItsNumber) {
  constexpr Angle small(0.5f), large(0.75f);
  static_assert(small + large == Angle(1.25f) && small - large == -Angle(0.25f));
  static_assert(2.0f * small == Angle(1.0f) && small * 2.0f == Angle(1.0f) && large / 3.0f == Angle(0.25f));
  static_assert(large / small == 1.5f);
  static_assert(min(small, large) == small && max(small, large) == large);
  static_assert(clamp(small, large, Angle(1.0f)) == large && clamp(large, Angle(0.0f), small) == small);
  EXPECT_EQ(floor(Cell(2.75f)), Cell(2.0f));
  EXPECT_EQ(static_cast<uint>(Cell(2.75f)), 2u);
}

}  // namespace
}  // namespace airlight::shaders
