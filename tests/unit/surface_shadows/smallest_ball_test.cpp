#include "surface_shadows/smallest_ball.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"

namespace airlight::surface_shadows {
namespace {

TEST(SmallestBall, OfPointsWhoseBallIsKnown) {
  const std::vector<glm::dvec3> one = {{1, 2, 3}};
  EXPECT_EQ(smallest_ball(one).centre, one[0]);
  EXPECT_EQ(smallest_ball(one).radius, 0.0);
  const std::vector<glm::dvec3> same(5, {1, 2, 3});
  EXPECT_EQ(smallest_ball(same).radius, 0.0);
  const std::vector<glm::dvec3> in_line = {{0, 0, 0}, {1, 1, 1}, {4, 4, 4}, {2, 2, 2}, {4, 4, 4}};
  EXPECT_NEAR(smallest_ball(in_line).radius, 2 * std::sqrt(3.0), 1e-12);
  const std::vector<glm::dvec3> cube = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  EXPECT_NEAR(smallest_ball(cube).radius, std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(glm::distance(smallest_ball(cube).centre, {0.5, 0.5, 0.5}), 0.0, 1e-9);
  const std::vector<glm::dvec3> obtuse = {{-1, 0, 0}, {1, 0, 0}, {0.1, 0.1, 0}};
  EXPECT_NEAR(smallest_ball(obtuse).radius, 1.0, 1e-12) << "two of them hold the third";
  const std::vector<glm::dvec2> corners = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.3, 0.2}};
  EXPECT_NEAR(smallest_ball(corners).radius, std::sqrt(0.5), 1e-12);
}

/// The ball through some points that has its centre among them.
template <int Dimensions>
double radius_by_descent(const std::vector<glm::vec<Dimensions, double>>& points) {
  // Badoiu and Clarkson: towards the farthest point, by less and less.
  glm::vec<Dimensions, double> centre = points.front();
  double radius = 0.0;
  for (int i = 1; i < 20000; ++i) {
    auto farthest = points.front();
    for (const auto& point : points)
      if (glm::distance(point, centre) > glm::distance(farthest, centre)) farthest = point;
    radius = glm::distance(farthest, centre);
    centre += (farthest - centre) / static_cast<double>(i + 1);
  }
  return radius;
}

TEST(SmallestBall, HoldsAllPointsAndIsNoLargerThanAnother) {
  tests::Random random(1);
  for (int i = 0; i < 60; ++i) {
    std::vector<glm::dvec3> points;
    const int count = 1 + static_cast<int>(random.uniform() * 40);
    const double flatness = random.logarithmic(1e-9, 1.0);
    for (int k = 0; k < count; ++k)
      points.push_back(1e3 + random.in_box(1.0) * glm::dvec3(1.0, 1.0, i % 3 == 0 ? 0.0 : flatness));
    const Ball<3> ball = smallest_ball(points);
    for (const glm::dvec3& point : points)
      EXPECT_LE(glm::distance(point, ball.centre), ball.radius * (1.0 + 1e-12));
    const double other = radius_by_descent<3>(points);
    EXPECT_LE(ball.radius, other * (1.0 + 1e-9)) << i;
    EXPECT_GE(ball.radius, other * (1.0 - 2e-2)) << i;
  }
}

}  // namespace
}  // namespace airlight::surface_shadows
