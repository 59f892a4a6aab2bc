#include "frame/light_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "frame/clusters.h"

namespace airlight::frame {
namespace {

/// Shaders find in single precision what lies within a cone or a range.
constexpr double k_angle_margin = 1e-3;  // [rad]
constexpr double k_range_margin = 1e-4;  // of the range and of the distance to the eye

/// What an image shows: the sums of multiples ≥ 0 of these unit directions, from the eye.
using Corners = std::array<glm::dvec3, 4>;

/// Distance of a point, relative to the eye, from what an image shows.
double distance_from(const Corners& seen, glm::dvec3 point) {
  double nearest = glm::length(point);  // of the eye
  bool is_inside = true;
  const glm::dvec3 middle = seen[0] + seen[1] + seen[2] + seen[3];
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const glm::dvec3 &edge = seen[i], &next = seen[(i + 1) % seen.size()];
    nearest = std::min(nearest, glm::distance(point, std::max(glm::dot(point, edge), 0.0) * edge));
    glm::dvec3 inwards = glm::normalize(glm::cross(edge, next));
    if (glm::dot(inwards, middle) < 0.0) inwards = -inwards;
    const double height = glm::dot(inwards, point);
    if (height >= 0.0) continue;
    is_inside = false;
    // Where the foot of the perpendicular lies between the two edges, it is on the side.
    const glm::dvec3 foot = point - height * inwards;
    const bool is_between = glm::dot(glm::cross(edge, foot), glm::cross(edge, next)) >= 0.0 &&
                            glm::dot(glm::cross(foot, next), glm::cross(edge, next)) >= 0.0;
    if (is_between) nearest = std::min(nearest, -height);
  }
  return is_inside ? 0.0 : nearest;
}

/// Whether a spot shines beside what an image shows: no point of the one is a point of the other. Points are
/// eye + v and light + w, with v of the pyramid and w of the spot's cone: there is one in both where eye −
/// light is a w − v.
bool is_apart(const scene::Cone& spot, const Corners& seen, glm::dvec3 eye_from_light) {
  // A pyramid of many sides about the cone.
  constexpr int k_sides = 16;
  const double angle = std::min(spot.outer + k_angle_margin, 0.5 * std::numbers::pi);
  const double out = std::sin(angle) / std::cos(std::numbers::pi / k_sides);
  const glm::dvec3 u = glm::normalize(glm::cross(
      spot.axis, std::abs(spot.axis.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dvec3 v = glm::cross(spot.axis, u);
  std::vector<glm::dvec3> difference = {spot.axis};
  for (int i = 0; i < k_sides; ++i) {
    const double around = 2.0 * std::numbers::pi * i / k_sides;
    difference.push_back(
        glm::normalize(std::cos(angle) * spot.axis + out * (std::cos(around) * u + std::sin(around) * v)));
  }
  for (const glm::dvec3& edge : seen) difference.push_back(-edge);
  // Never wrongly "yes".
  constexpr double k_rounding = 1e-14, k_margin = 1e-9;
  const std::vector<glm::dvec3> sides = sides_of_cone(difference, k_rounding);
  return std::any_of(sides.begin(), sides.end(), [&](const glm::dvec3& inwards) {
    return glm::dot(inwards, eye_from_light) <= -k_margin * glm::length(eye_from_light);
  });
}

}  // namespace

double shortest_path(const scene::View& view, const scene::Light& light) {
  const double between = scene::is_sun(light) ? std::numeric_limits<double>::infinity()
                                              : glm::distance(light.position, view.camera.eye);
  // A sun's own path has no length in a medium without a top. In a layer, paths lead at least from its top
  // down to the eye, and from a lamp up to it where that is shorter than straight through.
  if (!view.medium.top) return scene::is_sun(light) ? 0.0 : between;
  const auto below_top = [&](double y) { return std::max(*view.medium.top - y, 0.0); };
  return std::min(between,
                  below_top(view.camera.eye.y) + (scene::is_sun(light) ? 0.0 : below_top(light.position.y)));
}

bool may_reach(const scene::View& view, const scene::Light& light) {
  const glm::vec3 extinction = view.medium.sigma_s + view.medium.sigma_a;
  const double depth =
      shortest_path(view, light) * static_cast<double>(std::min({extinction.x, extinction.y, extinction.z}));
  if (depth > k_deepest_light) return false;
  if (scene::is_sun(light) || (!light.range && !light.cone)) return true;

  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  Corners seen = scene::corner_rays(camera);
  for (glm::dvec3& edge : seen) edge = glm::normalize(edge);
  const glm::dvec3 from_eye = light.position - camera.eye;
  if (light.range &&
      distance_from(seen, from_eye) > *light.range + k_range_margin * (*light.range + glm::length(from_eye)))
    return false;
  return !light.cone || !is_apart(*light.cone, seen, -from_eye);
}

}  // namespace airlight::frame
