#include "surface_shadows/cluster_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>

#include "surface_shadows/smallest_ball.h"

namespace airlight::surface_shadows {
namespace {

constexpr double k_least_elongation = 2.0;  ///< of what has a capsule

// What doubles computed from floats is right to this part of their size, with room to spare.
constexpr double k_rounding = 1e-12;

float rounded_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value
             ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
             : rounded;
}

float rounded_down(double value) {
  return -rounded_up(-value);
}

/// A box turned about, its longest axis first.
struct TurnedBox {
  std::array<glm::dvec3, 3> axes;
  glm::dvec3 extent;
};

/// The box along the eigenvectors of the corners' covariance.
TurnedBox turned_box(std::span<const glm::dvec3> corners) {
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& corner : corners) mean += corner / static_cast<double>(corners.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const glm::dvec3& corner : corners) {
    const Eigen::Vector3d away(corner.x - mean.x, corner.y - mean.y, corner.z - mean.z);
    covariance += away * away.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  struct Side {
    glm::dvec3 axis;
    double extent;
  };
  std::array<Side, 3> sides;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d vector = solver.eigenvectors().col(i);
    const glm::dvec3 axis(vector.x(), vector.y(), vector.z());
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const glm::dvec3& corner : corners) {
      const double height = glm::dot(axis, corner - mean);
      least = std::min(least, height);
      most = std::max(most, height);
    }
    sides[static_cast<std::size_t>(i)] = {axis, most - least};
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.extent > b.extent; });
  return {{sides[0].axis, sides[1].axis, sides[2].axis}, {sides[0].extent, sides[1].extent, sides[2].extent}};
}

double distance_to_segment(glm::dvec3 point, glm::dvec3 from, glm::dvec3 to) {
  const glm::dvec3 along = to - from;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(point - from, along) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(point, from + t * along);
}

/// The ends of the capsule around a box's first axis: the smallest circle around the corners as they are seen
/// along it, and as short as the caps allow.
std::array<glm::dvec3, 2> capsule_ends(std::span<const glm::dvec3> corners, const TurnedBox& box) {
  const glm::dvec3 origin = corners.front();
  std::vector<glm::dvec2> seen;
  seen.reserve(corners.size());
  for (const glm::dvec3& corner : corners)
    seen.emplace_back(glm::dot(box.axes[1], corner - origin), glm::dot(box.axes[2], corner - origin));
  const Ball<2> circle = smallest_ball(seen);
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double aside = glm::distance(seen[i], circle.centre);
    const double cap = std::sqrt(std::max(circle.radius * circle.radius - aside * aside, 0.0));
    const double height = glm::dot(box.axes[0], corners[i] - origin);
    lower = std::min(lower, height + cap);
    upper = std::max(upper, height - cap);
  }
  // Caps that reach past each other leave one ball.
  if (lower > upper) lower = upper = 0.5 * (lower + upper);
  const glm::dvec3 middle = origin + circle.centre.x * box.axes[1] + circle.centre.y * box.axes[2];
  return {middle + lower * box.axes[0], middle + upper * box.axes[0]};
}

}  // namespace

ClusterBounds bounds_of(const scene::Geometry& geometry, std::span<const glm::uvec3> triangles,
                        bool has_capsules) {
  std::vector<glm::dvec3> corners;
  corners.reserve(3 * triangles.size());
  for (const glm::uvec3& t : triangles)
    for (const glm::uint corner : {t.x, t.y, t.z}) corners.emplace_back(geometry.positions[corner]);
  const TurnedBox box = turned_box(corners);

  // A capsule or a sphere, its ends rounded, then its radius from those.
  ClusterBounds bounds;
  if (has_capsules && box.extent[0] > 0.0 && box.extent[0] >= k_least_elongation * box.extent[1]) {
    const std::array<glm::dvec3, 2> ends = capsule_ends(corners, box);
    bounds.from = glm::vec3(ends[0]);
    bounds.to = glm::vec3(ends[1]);
  } else {
    bounds.from = bounds.to = glm::vec3(smallest_ball(std::span<const glm::dvec3>(corners)).centre);
  }
  const glm::dvec3 from(bounds.from), to(bounds.to);
  double radius = 0.0, farthest = 0.0;
  for (const glm::dvec3& corner : corners) {
    radius = std::max(radius, distance_to_segment(corner, from, to));
    farthest = std::max(farthest, glm::distance(corner, from));
  }
  bounds.radius = rounded_up(radius + k_rounding * farthest);

  // The cone of normals.
  std::vector<glm::dvec3> normals;
  double least_altitude = std::numeric_limits<double>::infinity();
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const glm::dvec3 a = corners[i], b = corners[i + 1], c = corners[i + 2];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const double altitude = longest > 0.0 ? glm::length(normal) / longest : 0.0;
    least_altitude = std::min(least_altitude, altitude);
    if (altitude <= 0.0) continue;
    normals.push_back(normal / (altitude * longest));
    sum += normals.back();
  }
  bounds.least_altitude = rounded_down(least_altitude);
  const bool has_axis = glm::length(sum) > 1e-3;
  bounds.axis = glm::vec3(has_axis ? glm::normalize(sum) : box.axes[2]);
  bounds.opening = k_any_direction;
  if (has_axis && normals.size() == triangles.size()) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(bounds.axis));
    double opening = 0.0;
    for (const glm::dvec3& normal : normals)
      opening = std::max(opening, 2.0 * std::atan2(glm::distance(normal, axis), glm::length(normal + axis)));
    bounds.opening = rounded_up(opening + k_rounding);
  }

  // The slabs.
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (const glm::dvec3& corner : corners) {
    const double height = glm::dot(glm::dvec3(bounds.axis), corner - from);
    lower = std::min(lower, height);
    upper = std::max(upper, height);
  }
  bounds.lower = rounded_down(lower - k_rounding * farthest);
  bounds.upper = rounded_up(upper + k_rounding * farthest);
  return bounds;
}

ClusterBounds moved(const ClusterBounds& bounds, const scene::Rigid& motion) {
  const glm::dvec3 from_at_rest(bounds.from), to_at_rest(bounds.to);
  const glm::dvec3 from = motion(from_at_rest), to = motion(to_at_rest),
                   axis = motion.turned(glm::dvec3(bounds.axis));
  const double radius = static_cast<double>(bounds.radius);
  ClusterBounds result;
  result.from = glm::vec3(from);
  result.to = glm::vec3(to);
  result.axis = glm::vec3(axis);

  // How far rounding has moved the ends and the axis, and may have moved a corner: each of its coordinates by
  // half a unit in the last place, and by what the motion's own double precision loses.
  const double from_error = glm::distance(glm::dvec3(result.from), from);
  const double end_error = std::max(from_error, glm::distance(glm::dvec3(result.to), to));
  const double axis_error = glm::distance(glm::dvec3(result.axis), axis);
  const auto largest = [](glm::dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  const double reach = std::max(largest(from), largest(to)) + radius;
  const double reach_at_rest = std::max(largest(from_at_rest), largest(to_at_rest)) + radius;
  constexpr double k_half_unit = 0x1p-24, k_least_unit = 0x1p-149, k_diagonal = 1.7320509;
  const double corner_error = k_diagonal * (k_half_unit * (1.0 + 1e-6) * reach + k_least_unit) +
                              k_rounding * (reach + reach_at_rest + largest(glm::dvec3(motion.matrix[3])));

  result.radius = rounded_up(radius + corner_error + end_error);
  const double farthest = glm::distance(from, to) + radius;
  const double height_error = 1.000001 * (axis_error * farthest + corner_error + from_error);
  result.lower = rounded_down(static_cast<double>(bounds.lower) - height_error);
  result.upper = rounded_up(static_cast<double>(bounds.upper) + height_error);

  // A triangle is lower at most by what two ends of an altitude are off. Its plane, off by no more at three
  // corners, is turned by a slope of twice that over the least width, which is the least altitude.
  const double altitude = static_cast<double>(bounds.least_altitude) - 2.000001 * corner_error;
  result.least_altitude = rounded_down(std::max(altitude, 0.0));
  const double turn = altitude > 0.0 ? 2.000001 * corner_error / altitude : 1.0;
  result.opening =
      turn < 0.1
          ? std::min(rounded_up(static_cast<double>(bounds.opening) + turn + 1.1 * axis_error + k_rounding),
                     k_any_direction)
          : k_any_direction;
  return result;
}

}  // namespace airlight::surface_shadows
