#include "scene/catmull_rom.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace airlight::scene {
namespace {

using D = glm::dvec3;
using Keys = std::vector<std::pair<double, D>>;

const Keys k_uneven = {
    {0.0, {0, 0, 0}}, {0.5, {1, 2, -1}}, {3.0, {2, -1, 0}}, {3.25, {2, 5, 7}}, {7.0, {0, 1, 1}}};

CatmullRom curve_through(const Keys& keys) {
  CatmullRom curve;
  for (const auto& [time, value] : keys) curve.add(time, value);
  return curve;
}

TEST(CatmullRom, GoesThroughItsKeys) {
  const CatmullRom curve = curve_through(k_uneven);
  for (const auto& [time, value] : k_uneven) EXPECT_EQ(curve.at(time), value) << time;
}

TEST(CatmullRom, HasNoJumpInPlaceOrVelocity) {
  const CatmullRom curve = curve_through(k_uneven);
  constexpr double k_step = 1e-6;
  const auto velocity = [&](double from) { return (curve.at(from + k_step) - curve.at(from)) / k_step; };
  for (const auto& [time, value] : k_uneven) {
    EXPECT_NEAR(glm::distance(curve.at(time - k_step), value), 0.0, 1e-4) << time;
    EXPECT_NEAR(glm::distance(velocity(time - k_step), velocity(time)), 0.0, 1e-3) << time;
  }
}

TEST(CatmullRom, RestsBeforeItsFirstKeyAndAfterItsLast) {
  const CatmullRom curve = curve_through(k_uneven);
  EXPECT_EQ(curve.at(-1.0), k_uneven.front().second);
  EXPECT_EQ(curve.at(9.0), k_uneven.back().second);
}

TEST(CatmullRom, OfASingleKeyRests) {
  const CatmullRom curve = curve_through({{2.0, {1, 2, 3}}});
  for (const double time : {0.0, 2.0, 5.0}) EXPECT_EQ(curve.at(time), D(1, 2, 3));
}

TEST(CatmullRom, RestsBetweenEqualKeys) {
  const CatmullRom curve =
      curve_through({{0.0, {0, 0, 0}}, {1.0, {0.1, 0.7, 0.3}}, {2.3, {0.1, 0.7, 0.3}}, {3.0, {5, 5, 5}}});
  for (const double time : {1.0, 1.1, 1.7, 2.29, 2.3}) EXPECT_EQ(curve.at(time), D(0.1, 0.7, 0.3)) << time;
}

TEST(CatmullRom, IsTheParabolaOfUniformMotionWithinItsEnds) {
  // Knots at the keys' own times: what is uniformly accelerated stays so, however uneven the keys.
  const auto place = [](double t) { return D(2.0 - t, 0.5 * t * t, 3.0 * t - 0.25 * t * t); };
  Keys keys;
  for (const double time : {0.0, 0.3, 1.9, 2.0, 4.0, 7.0}) keys.emplace_back(time, place(time));
  const CatmullRom curve = curve_through(keys);
  for (const double time : {0.5, 1.0, 1.95, 2.5, 3.9})
    EXPECT_NEAR(glm::distance(curve.at(time), place(time)), 0.0, 1e-12) << time;
}

}  // namespace
}  // namespace airlight::scene
