#include "surface_shadows/smallest_ball.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/QR>

namespace airlight::surface_shadows {
namespace {

template <int Dimensions>
class Search {
 public:
  using Point = glm::vec<Dimensions, double>;

  explicit Search(std::span<const Point> points) : points_(points.begin(), points.end()) {
    Point least = points_.front(), most = least;
    for (const Point& point : points_) {
      least = glm::min(least, point);
      most = glm::max(most, point);
    }
    middle_ = 0.5 * (least + most);
    for (Point& point : points_) point -= middle_;
    tolerance_ = 1e-10 * glm::length(most - least);
  }

  Ball<Dimensions> find() {
    Ball<Dimensions> ball = around_first(points_.size(), {});
    ball.radius = 0.0;
    for (const Point& point : points_) ball.radius = std::max(ball.radius, glm::distance(point, ball.centre));
    ball.centre += middle_;
    return ball;
  }

 private:
  /// The smallest ball around the first `count` points that has `boundary` on its boundary. Points that made
  /// it grow come first afterwards.
  Ball<Dimensions> around_first(std::size_t count, const std::vector<Point>& boundary) {
    Ball<Dimensions> ball = through(boundary);
    if (boundary.size() == Dimensions + 1) return ball;
    for (std::size_t i = 0; i < count; ++i) {
      const Point point = points_[i];
      if (glm::distance(point, ball.centre) <= ball.radius + tolerance_) continue;
      std::vector<Point> with_point = boundary;
      with_point.push_back(point);
      ball = around_first(i, with_point);
      const auto at = points_.begin() + static_cast<std::ptrdiff_t>(i);
      std::rotate(points_.begin(), at, at + 1);
    }
    return ball;
  }

  /// The smallest ball that has all of `boundary` on its boundary; of none, one that holds nothing.
  static Ball<Dimensions> through(const std::vector<Point>& boundary) {
    if (boundary.empty()) return {Point(0.0), -std::numeric_limits<double>::infinity()};
    // Its centre c is as far from each point p as from the first one, q: 2 (p − q) · (c − q) = |p − q|².
    const Point& first = boundary.front();
    Eigen::Matrix<double, Eigen::Dynamic, Dimensions, 0, Dimensions, Dimensions> equations(
        boundary.size() - 1, Dimensions);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dimensions, 1> right(boundary.size() - 1);
    for (std::size_t i = 1; i < boundary.size(); ++i) {
      const Point edge = boundary[i] - first;
      const auto row = static_cast<Eigen::Index>(i - 1);
      for (int k = 0; k < Dimensions; ++k) equations(row, k) = 2.0 * edge[k];
      right(row) = glm::dot(edge, edge);
    }
    Point to_centre(0.0);
    if (boundary.size() > 1) {
      const Eigen::Matrix<double, Dimensions, 1> solution =
          equations.completeOrthogonalDecomposition().solve(right);
      for (int k = 0; k < Dimensions; ++k) to_centre[k] = solution[k];
    }
    return {first + to_centre, glm::length(to_centre)};
  }

  std::vector<Point> points_;  ///< relative to `middle_`
  Point middle_;
  double tolerance_;
};

}  // namespace

Ball<3> smallest_ball(std::span<const glm::dvec3> points) {
  return Search<3>(points).find();
}
Ball<2> smallest_ball(std::span<const glm::dvec2> points) {
  return Search<2>(points).find();
}

}  // namespace airlight::surface_shadows
