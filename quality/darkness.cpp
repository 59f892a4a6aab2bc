#include "quality/darkness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "frame/light_reach.h"
#include "quality/truth.h"
#include "scene/components.h"
#include "scene/edges.h"

namespace airlight::quality {
namespace {

double largest(glm::vec3 v) {
  return std::max({v.x, v.y, v.z});
}

/// Whether the segment from a to b crosses the triangle.
bool crosses(glm::dvec3 a, glm::dvec3 b, const std::array<glm::dvec3, 3>& corners) {
  // Seen from a, b is on one side of the triangle's plane; so are the edges about the segment.
  const auto volume = [](glm::dvec3 u, glm::dvec3 v, glm::dvec3 w) { return glm::dot(glm::cross(u, v), w); };
  const glm::dvec3 p = corners[0] - a, q = corners[1] - a, r = corners[2] - a, d = b - a;
  const bool side = volume(p, q, d) > 0.0;
  if ((volume(q, r, d) > 0.0) != side || (volume(r, p, d) > 0.0) != side) return false;
  const glm::dvec3 normal = glm::cross(q - p, r - p);
  return (glm::dot(normal, p) > 0.0) != (glm::dot(normal, p - d) > 0.0);
}

/// For each closed part of the scene, whether it separates two points: whether a path between them crosses it
/// an odd number of times. Any path does, so several are asked, and parts that they disagree on are left out.
std::vector<bool> separating(const scene::Geometry& geometry, const scene::Components& parts,
                             const std::vector<bool>& is_closed, glm::dvec3 from, glm::dvec3 to) {
  const scene::Box box = scene::bounds(geometry);
  const glm::dvec3 extent(box.upper - box.lower);
  constexpr std::array k_places = {glm::dvec3(0.17, 0.71, 0.43), glm::dvec3(0.83, 0.29, 0.61),
                                   glm::dvec3(0.37, 0.53, 0.89)};
  std::vector<int> odd(parts.count, 0);
  for (const glm::dvec3& place : k_places) {
    const glm::dvec3 by = glm::dvec3(box.lower) + place * extent;
    std::vector<bool> is_odd(parts.count, false);
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
      const std::uint32_t part = parts.of_triangle[t];
      if (!is_closed[part]) continue;
      std::array<glm::dvec3, 3> corners;
      for (int i = 0; i < 3; ++i)
        corners[static_cast<std::size_t>(i)] = geometry.positions[geometry.triangles[t][i]];
      if (crosses(from, by, corners) != crosses(by, to, corners)) is_odd[part] = !is_odd[part];
    }
    for (std::size_t part = 0; part < parts.count; ++part) odd[part] += is_odd[part] ? 1 : 0;
  }
  std::vector<bool> separate(parts.count);
  for (std::size_t part = 0; part < parts.count; ++part)
    separate[part] = odd[part] == static_cast<int>(k_places.size());
  return separate;
}

/// What closed part keeps the light from the eye; empty for none.
std::string enclosure(const scene::Geometry& geometry, glm::dvec3 light, glm::dvec3 eye) {
  if (geometry.triangles.empty()) return {};
  const scene::Edges edges = scene::find_edges(geometry);
  const scene::Components parts = scene::find_components(geometry, edges);
  std::vector<bool> is_closed(parts.count, true);
  for (const scene::Edges::Edge& edge : edges.edges)
    if (edge.count % 2 != 0) is_closed[parts.of_triangle[edges.triangles_of(edge)[0]]] = false;
  const std::vector<bool> separate = separating(geometry, parts, is_closed, light, eye);
  const auto found = std::find(separate.begin(), separate.end(), true);
  if (found == separate.end()) return {};
  const auto part = static_cast<std::uint32_t>(found - separate.begin());

  // It holds one of the two, and not what is far outside.
  const scene::Box box = scene::bounds(geometry);
  const glm::dvec3 outside =
      glm::dvec3(box.upper) + glm::length(glm::dvec3(box.upper - box.lower)) * glm::dvec3(1.1, 1.3, 1.7);
  const bool holds_light = separating(geometry, parts, is_closed, light, outside)[part];
  return fmt::format("the {} is inside a closed part of the scene ({} triangles), and the {} is not",
                     holds_light ? "light" : "eye",
                     std::count(parts.of_triangle.begin(), parts.of_triangle.end(), part),
                     holds_light ? "eye" : "light");
}

/// A point where the light is; of a sun, one that lies towards it beyond all geometry.
glm::dvec3 place_of(const scene::Light& light, const scene::Geometry& geometry) {
  if (!is_sun(light)) return light.position;
  const scene::Box box = scene::bounds(geometry);
  const glm::dvec3 lower = box.lower, upper = box.upper;
  return 0.5 * (lower + upper) + 2.0 * glm::distance(lower, upper) * light.towards;
}

}  // namespace

bool is_black(const std::vector<glm::vec3>& radiance) {
  return std::all_of(radiance.begin(), radiance.end(),
                     [](const glm::vec3& value) { return largest(value) < k_least; });
}

std::string why_black(const scene::Geometry& geometry, const scene::View& view) {
  if (!view.pose.is_at_rest()) {
    scene::View of_posed = view;
    of_posed.pose = {};
    return why_black(scene::posed(geometry, view.pose), of_posed);
  }
  std::string why;
  for (const scene::Light& light : view.lights) {
    const double path = frame::shortest_path(view, light);
    const glm::vec3 extinction = view.medium.sigma_s + view.medium.sigma_a;
    const double depth = path * static_cast<double>(std::min({extinction.x, extinction.y, extinction.z}));
    std::string of_light;
    const double power = largest(is_sun(light) ? light.irradiance : light.intensity);
    if (power < k_least) {
      of_light = fmt::format("the light's {} is {:.3g}", is_sun(light) ? "irradiance" : "intensity", power);
    } else if (power * std::exp(-depth) < k_least) {
      of_light = fmt::format(
          "no path from the light to the eye is shorter than {:.3g} m in the medium, which lets through "
          "e^-{:.4g}",
          path, depth);
    } else if (!frame::may_reach(view, light)) {
      of_light = "nothing that is seen lies within the light's cone and range";
    } else {
      of_light = enclosure(geometry, place_of(light, geometry), view.camera.eye);
    }
    if (of_light.empty()) return "whatever is seen lies in shadow, or neither reflects nor scatters";
    if (view.lights.size() > 1) of_light = fmt::format("of light '{}': {}", light.name, of_light);
    why += fmt::format("{}{}", why.empty() ? "" : "; ", of_light);
  }
  return why;
}

}  // namespace airlight::quality
