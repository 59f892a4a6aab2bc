#include "viewer/cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace airlight::viewer {
namespace {

/// How near to straight up or down a view may come [rad].
constexpr double k_pole = 0.01;

struct Axes {
  glm::dvec3 up, right, forward;  ///< orthogonal but for `forward`, which may look up or down; unit length
  double distance;                ///< from eye to target
};

Axes axes_of(const scene::Camera& camera) {
  Axes axes{};
  axes.up = glm::normalize(camera.up);
  axes.distance = glm::distance(camera.eye, camera.target);
  axes.forward = (camera.target - camera.eye) / axes.distance;
  axes.right = glm::normalize(glm::cross(axes.forward, axes.up));
  return axes;
}

/// `forward` turned about `up` to the right, and downwards.
glm::dvec3 turned(const Axes& axes, double right, double down) {
  const double elevation = std::asin(std::clamp(glm::dot(axes.forward, axes.up), -1.0, 1.0));
  const double limit = 0.5 * std::numbers::pi - k_pole;
  const double to = std::clamp(elevation - down, std::min(-limit, elevation), std::max(limit, elevation));
  const glm::dvec3 ahead = glm::cross(axes.up, axes.right);
  const glm::dvec3 level = std::cos(right) * ahead + std::sin(right) * axes.right;
  return std::cos(to) * level + std::sin(to) * axes.up;
}

}  // namespace

void look(scene::Camera& camera, double right, double down) {
  const Axes axes = axes_of(camera);
  camera.target = camera.eye + axes.distance * turned(axes, right, down);
}

void orbit(scene::Camera& camera, double right, double down) {
  const Axes axes = axes_of(camera);
  camera.eye = camera.target - axes.distance * turned(axes, right, down);
}

void pan(scene::Camera& camera, double right, double up) {
  const Axes axes = axes_of(camera);
  const glm::dvec3 way = right * axes.right + up * glm::cross(axes.right, axes.forward);
  camera.eye += way;
  camera.target += way;
}

void dolly(scene::Camera& camera, double amount) {
  const double distance = glm::distance(camera.eye, camera.target);
  const double to = std::max(distance * std::exp(-amount), 1e-6 * (1.0 + glm::length(camera.target)));
  camera.eye = camera.target + (camera.eye - camera.target) * (to / distance);
}

void fly(scene::Camera& camera, glm::dvec3 way) {
  const Axes axes = axes_of(camera);
  const glm::dvec3 moved = way.x * axes.right + way.y * axes.up + way.z * axes.forward;
  camera.eye += moved;
  camera.target += moved;
}

glm::dvec3 project(const scene::CameraFrame& camera, glm::dvec2 image_size, glm::dvec3 point) {
  const glm::dvec3 from_eye = point - camera.eye;
  const double depth = glm::dot(from_eye, camera.forward);
  const double x = glm::dot(from_eye, camera.right) / (depth * camera.half_width);
  const double y = glm::dot(from_eye, camera.up) / (depth * camera.half_height);
  return {0.5 * (x + 1.0) * image_size.x, 0.5 * (1.0 - y) * image_size.y, depth};
}

glm::dvec3 project(const scene::CameraFrame& camera, glm::dvec2 image_size, const scene::Light& light) {
  return project(camera, image_size, scene::is_sun(light) ? camera.eye + light.towards : light.position);
}

}  // namespace airlight::viewer
