#include "frame/shadow_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "frame/clusters.h"
#include "frame/shadow_map.h"

namespace airlight::frame {
namespace {

/// A convex polygon.
using Polygon = std::vector<glm::dvec3>;

/// What of the polygon lies in the half-space through the origin.
Polygon cut(const Polygon& polygon, const glm::dvec3& inward) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double height_p = glm::dot(inward, p), height_q = glm::dot(inward, q);
    if (height_p >= 0.0) inside.push_back(p);
    if ((height_p < 0.0) != (height_q < 0.0))
      inside.push_back(p + height_p / (height_p - height_q) * (q - p));
  }
  return inside;
}

/// The corners of a box, positions relative to the eye, cut by half-spaces through the eye.
std::vector<glm::dvec3> corners_of(const glm::dvec3& lower, const glm::dvec3& upper,
                                   const std::vector<glm::dvec3>& inward) {
  std::vector<glm::dvec3> corners;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {lower[axis], upper[axis]}) {
      Polygon face;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const auto& [at_u, at_v] : {std::pair(lower[u], lower[v]), std::pair(upper[u], lower[v]),
                                       std::pair(upper[u], upper[v]), std::pair(lower[u], upper[v])}) {
        glm::dvec3 corner;
        corner[axis] = side;
        corner[u] = at_u;
        corner[v] = at_v;
        face.push_back(corner);
      }
      for (const glm::dvec3& normal : inward) face = cut(face, normal);
      corners.insert(corners.end(), face.begin(), face.end());
    }
  }
  if (glm::all(glm::lessThanEqual(lower, glm::dvec3(0.0))) &&
      glm::all(glm::greaterThanEqual(upper, glm::dvec3(0.0))))
    corners.emplace_back(0.0);
  return corners;
}

}  // namespace

bool ShadowPlane::may_touch(const scene::Box& box) const {
  return frame::may_touch(eye, half_spaces, box);
}

std::optional<ShadowPlane> fit_shadow_plane(const scene::Light& light, const scene::CameraFrame& camera,
                                            const scene::Box& box, int size) {
  const glm::dvec3 l = scene::direction_to(light, camera.eye);
  const double inverse_distance =
      scene::is_sun(light) ? 0.0 : 1.0 / glm::distance(light.position, camera.eye);
  ShadowPlane plane;
  plane.eye = camera.eye;
  std::array<glm::dvec3, 5> directions{};
  const std::array<glm::dvec3, 4> corners = scene::corner_rays(camera);
  std::transform(corners.begin(), corners.end(), directions.begin(),
                 [](const glm::dvec3& corner) { return glm::normalize(corner); });
  directions[4] = l;
  constexpr double k_rounding = 1e-12;
  plane.half_spaces = sides_of_cone(directions, k_rounding);

  // What can shade what is seen, on the map.
  const glm::dvec3 across = camera.right - glm::dot(camera.right, l) * l;
  const glm::dvec3 first =
      glm::normalize(glm::length(across) > 0.1 ? across : camera.up - glm::dot(camera.up, l) * l);
  const glm::dvec3 second = glm::cross(l, first);
  double least_share = 1.0, farthest = 0.0;
  std::vector<glm::dvec3> mapped;  // along first, second and l
  if (!box.empty()) {
    for (const glm::dvec3& p : corners_of(glm::dvec3(box.lower) - camera.eye,
                                          glm::dvec3(box.upper) - camera.eye, plane.half_spaces)) {
      const double share = 1.0 - inverse_distance * glm::dot(l, p);
      least_share = std::min(least_share, share);
      mapped.push_back(glm::dvec3(glm::dot(first, p), glm::dot(second, p), glm::dot(l, p)) / share);
      farthest = std::max(farthest, std::hypot(mapped.back().x, mapped.back().y));
    }
  }
  // A point's light rays are to cross the plane within half a right angle of the axis, and what they meet is
  // not to be blown up by much.
  constexpr double k_least_share = 0.5, k_steepest = 0.7;
  if (least_share < k_least_share || inverse_distance * farthest > k_steepest) return std::nullopt;

  // The image that is turned so that it covers the least.
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  constexpr int k_turns = 32;          // of a right angle
  glm::dvec3 lower(-1.0), upper(1.0);  // where nothing can cast a shadow, anything will do
  glm::dvec2 turned(1.0, 0.0);
  double least_area = k_infinity;
  for (int turn = 0; turn < k_turns && !mapped.empty(); ++turn) {
    const double angle = 0.5 * std::numbers::pi * turn / k_turns;
    const glm::dvec2 direction(std::cos(angle), std::sin(angle));
    glm::dvec3 least(k_infinity), most(-k_infinity);
    for (const glm::dvec3& p : mapped) {
      const glm::dvec3 place(p.x * direction.x + p.y * direction.y, p.y * direction.x - p.x * direction.y,
                             p.z);
      least = glm::min(least, place);
      most = glm::max(most, place);
    }
    const double area = (most.x - least.x) * (most.y - least.y);
    if (area >= least_area) continue;
    least_area = area;
    lower = least;
    upper = most;
    turned = direction;
  }
  const glm::dvec3 right = turned.x * first + turned.y * second, up = turned.x * second - turned.y * first;
  const glm::dvec3 middle = 0.5 * (lower + upper);
  // A texel more on each side, and something where all lies in a plane.
  const double least = 1e-6 * (glm::length(upper - lower) + glm::length(middle)) + 1e-30;
  const glm::dvec3 half = (0.5 * (upper - lower) + least) * (1.0 + 2.0 / size);

  plane.image_x = glm::dvec4(right, -middle.x) / half.x;
  plane.image_y = glm::dvec4(up, -middle.y) / half.y;
  // Depth 0 stands for nothing.
  constexpr double k_depth_of_farthest = 0.1, k_depth_of_nearest = 0.9;
  plane.depth_scale = (k_depth_of_nearest - k_depth_of_farthest) / (2.0 * half.z);
  plane.depth_offset = k_depth_of_farthest - plane.depth_scale * (middle.z - half.z);
  plane.half_texel = std::max(half.x, half.y) / size;
  return plane;
}

ShadowPlaneMap::ShadowPlaneMap(const gpu::Context& context, int size)
    : pipeline_(make_shadow_map_pipeline(true)) {
  require_shadow_map(context, size);
  depth_ = gpu::Texture::array(gpu::Format::depth32f, {size, size}, 1);
  target_ = gpu::Framebuffer({}, gpu::Attachment(depth_, 0, 0));
}

void ShadowPlaneMap::draw(const SceneBuffers& scene, const ShadowPlane& plane) {
  target_.clear();
  pipeline_.draw(target_, scene, [&](const scene::Box& box) { return plane.may_touch(box); });
}

}  // namespace airlight::frame
