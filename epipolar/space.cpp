#include "epipolar/space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace airlight::epipolar {
namespace {

double angle_between(glm::dvec3 a, glm::dvec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

bool in_image(const scene::CameraFrame& camera, glm::dvec3 direction) {
  const double depth = glm::dot(direction, camera.forward);
  return depth > 0.0 && std::abs(glm::dot(direction, camera.right)) <= camera.half_width * depth &&
         std::abs(glm::dot(direction, camera.up)) <= camera.half_height * depth;
}

}  // namespace

Axes make_axes(glm::dvec3 l) {
  if (l.y < -1.0 + 1e-12) return {l, {0.0, 0.0, -1.0}, {1.0, 0.0, 0.0}};
  const double a = 1.0 / (1.0 + l.y);
  const double b = -l.z * l.x * a;
  return {l, {b, -l.z, 1.0 - l.z * l.z * a}, {1.0 - l.x * l.x * a, -l.x, b}};
}

Range alpha_range(const scene::CameraFrame& camera, glm::dvec3 axis) {
  using std::numbers::pi;
  Range range{pi, 0.0};
  const auto include = [&](glm::dvec3 ray) {
    const double angle = angle_between(axis, ray);
    range.lower = std::min(range.lower, angle);
    range.upper = std::max(range.upper, angle);
  };
  const auto point = [&](double x, double y) {
    return camera.forward + x * camera.half_width * camera.right + y * camera.half_height * camera.up;
  };
  const std::array<glm::dvec3, 4> corners = {point(-1, -1), point(1, -1), point(1, 1), point(-1, 1)};
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 a = corners[i], edge = corners[(i + 1) % 4] - a;
    include(a);
    // The cosine dot(l, a + s·edge) / |a + s·edge| is stationary where
    // dot(l, edge)·dot(p, p) = dot(l, p)·dot(p, edge), p = a + s·edge; the terms in s² cancel.
    const double la = glm::dot(axis, a), le = glm::dot(axis, edge);
    const double aa = glm::dot(a, a), ae = glm::dot(a, edge), ee = glm::dot(edge, edge);
    const double slope = le * ae - la * ee;
    if (slope == 0.0) continue;
    const double s = (la * ae - le * aa) / slope;
    if (s > 0.0 && s < 1.0) include(a + s * edge);
  }
  if (in_image(camera, axis)) range.lower = 0.0;
  if (in_image(camera, -axis)) range.upper = pi;
  return range;
}

Range theta_range(const scene::CameraFrame& camera, const Axes& axes) {
  using std::numbers::pi;
  if (in_image(camera, axes.axis) || in_image(camera, -axes.axis)) return {-pi, pi};
  // Seen along the axis the image is a convex cone that does not hold the origin: it spans less than π, its
  // extremes are corners, and all are within π of its inside.
  const auto theta = [&](glm::dvec3 ray) { return std::atan2(glm::dot(ray, axes.f), glm::dot(ray, axes.u)); };
  const double inside = theta(camera.forward);
  Range range{0.0, 0.0};
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const double corner =
          theta(camera.forward + x * camera.half_width * camera.right + y * camera.half_height * camera.up);
      const double from_inside = std::remainder(corner - inside, 2.0 * pi);
      range.lower = std::min(range.lower, from_inside);
      range.upper = std::max(range.upper, from_inside);
    }
  }
  return {inside + range.lower, inside + range.upper};
}

shaders::EpipolarBlock epipolar_block(const scene::View& view, const Resolution& resolution, Ranges ranges) {
  using std::numbers::pi;
  const glm::dvec3 to_light = view.light.position - view.camera.eye;
  const double distance = glm::length(to_light);
  const Axes axes = make_axes(to_light / distance);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const Range alpha = ranges == Ranges::full ? Range{0.0, pi} : alpha_range(camera, axes.axis);
  const Range theta = ranges == Ranges::frame ? theta_range(camera, axes) : Range{-pi, pi};
  shaders::EpipolarBlock block{};
  block.axis = glm::vec3(axes.axis);
  block.distance = static_cast<float>(distance);
  block.u = glm::vec3(axes.u);
  block.f = glm::vec3(axes.f);
  block.alpha_min = static_cast<float>(alpha.lower);
  block.alpha_step = static_cast<float>((alpha.upper - alpha.lower) / resolution.alpha);
  block.theta_middle = static_cast<float>(std::remainder(0.5 * (theta.lower + theta.upper), 2.0 * pi));
  block.theta_half = static_cast<float>(0.5 * (theta.upper - theta.lower));
  block.theta_step = static_cast<float>((theta.upper - theta.lower) / resolution.theta);
  return block;
}

}  // namespace airlight::epipolar
