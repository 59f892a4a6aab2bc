#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "scene/builtin_internal.h"

namespace airlight::scene {

void Modeller::box(glm::dvec3 lower, glm::dvec3 upper, double turn_degrees) {
  const glm::dvec3 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  const double c = std::cos(glm::radians(turn_degrees)), s = std::sin(glm::radians(turn_degrees));
  std::array<std::uint32_t, 8> v;
  for (std::size_t i = 0; i < 8; ++i) {
    const double x = i & 1 ? half.x : -half.x, y = i & 2 ? half.y : -half.y, z = i & 4 ? half.z : -half.z;
    v[i] = vertex(middle + glm::dvec3(c * x + s * z, y, c * z - s * x));
  }
  quad(v[0], v[4], v[6], v[2]);
  quad(v[1], v[3], v[7], v[5]);
  quad(v[0], v[1], v[5], v[4]);
  quad(v[2], v[6], v[7], v[3]);
  quad(v[0], v[2], v[3], v[1]);
  quad(v[4], v[5], v[7], v[6]);
}

void Modeller::sphere(glm::dvec3 centre, double radius, std::uint32_t cuts) {
  // An icosahedron, each of its faces cut into cuts² triangles.
  constexpr double g = std::numbers::phi;
  static constexpr std::array<glm::dvec3, 12> k_corners = {{{-1, g, 0},
                                                            {1, g, 0},
                                                            {-1, -g, 0},
                                                            {1, -g, 0},
                                                            {0, -1, g},
                                                            {0, 1, g},
                                                            {0, -1, -g},
                                                            {0, 1, -g},
                                                            {g, 0, -1},
                                                            {g, 0, 1},
                                                            {-g, 0, -1},
                                                            {-g, 0, 1}}};
  static constexpr std::array<std::array<std::uint32_t, 3>, 20> k_faces = {
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  // Points on an edge belong to two faces: a point is known by the weights of the corners between which it
  // lies.
  std::map<std::array<std::pair<std::uint32_t, std::uint32_t>, 3>, std::uint32_t> known;
  for (const auto& face : k_faces) {
    const auto point = [&](std::uint32_t i, std::uint32_t j) {
      const std::array<std::uint32_t, 3> weights = {cuts - i - j, i, j};
      std::array<std::pair<std::uint32_t, std::uint32_t>, 3> key{};
      glm::dvec3 sum(0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        sum += static_cast<double>(weights[k]) * k_corners[face[k]];
        if (weights[k] > 0) key[k] = {face[k], weights[k]};
      }
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = known.try_emplace(key, 0);
      if (is_new) at->second = vertex(centre + radius * glm::normalize(sum));
      return at->second;
    };
    for (std::uint32_t i = 0; i < cuts; ++i) {
      for (std::uint32_t j = 0; i + j < cuts; ++j) {
        triangle(point(i, j), point(i + 1, j), point(i, j + 1));
        if (i + j + 1 < cuts) triangle(point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
      }
    }
  }
}

void Modeller::tube(std::size_t rings, std::uint32_t sides,
                    const std::function<glm::dvec3(std::size_t ring, double angle)>& at) {
  std::vector<std::uint32_t> first(sides), below(sides), ring(sides);
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::uint32_t k = 0; k < sides; ++k) ring[k] = vertex(at(i, 2.0 * std::numbers::pi * k / sides));
    for (std::uint32_t k = 0; k < sides && i > 0; ++k)
      quad(below[k], below[(k + 1) % sides], ring[(k + 1) % sides], ring[k]);
    if (i == 0) first = ring;
    below = ring;
  }
  for (std::uint32_t k = 1; k + 1 < sides; ++k) {
    triangle(first[0], first[k + 1], first[k]);
    triangle(ring[0], ring[k], ring[k + 1]);
  }
}

void Modeller::turned(glm::dvec3 foot, std::span<const glm::dvec2> profile, std::uint32_t sides) {
  tube(profile.size(), sides, [&](std::size_t i, double angle) {
    return foot + glm::dvec3(profile[i].x * std::sin(angle), profile[i].y, profile[i].x * std::cos(angle));
  });
}

void Modeller::rod(std::span<const glm::dvec4> path, std::uint32_t sides) {
  const auto centre = [&](std::size_t i) { return glm::dvec3(path[i]); };
  std::vector<std::array<glm::dvec3, 2>> axes;  // across the rod, at each point
  for (std::size_t i = 0; i < path.size(); ++i) {
    const glm::dvec3 along =
        glm::normalize(centre(std::min(i + 1, path.size() - 1)) - centre(i > 0 ? i - 1 : 0));
    // Carried along, so that the rod is not twisted.
    glm::dvec3 side = i > 0                     ? axes.back()[0]
                      : std::abs(along.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0)
                                                : glm::dvec3(1.0, 0.0, 0.0);
    side = glm::normalize(side - glm::dot(side, along) * along);
    axes.push_back({side, glm::cross(along, side)});
  }
  tube(path.size(), sides, [&](std::size_t i, double angle) {
    return centre(i) + path[i].w * (std::cos(angle) * axes[i][0] + std::sin(angle) * axes[i][1]);
  });
}

void Modeller::slab(std::span<const double> x, std::span<const double> z, double bottom,
                    const std::function<double(double, double)>& height) {
  const std::size_t columns = x.size(), rows = z.size();
  const auto first = static_cast<std::uint32_t>(geometry_.positions.size());
  const auto at = [&](std::size_t i, std::size_t j) {
    return first + static_cast<std::uint32_t>(j * columns + i);
  };
  for (double v : z)
    for (double u : x) vertex({u, height(u, v), v});
  for (std::size_t j = 0; j + 1 < rows; ++j)
    for (std::size_t i = 0; i + 1 < columns; ++i)
      quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));

  // Its rim, counter-clockwise seen from above, goes down to the lower face, a fan.
  std::vector<std::uint32_t> rim;
  for (std::size_t j = 0; j + 1 < rows; ++j) rim.push_back(at(0, j));
  for (std::size_t i = 0; i + 1 < columns; ++i) rim.push_back(at(i, rows - 1));
  for (std::size_t j = rows - 1; j > 0; --j) rim.push_back(at(columns - 1, j));
  for (std::size_t i = columns - 1; i > 0; --i) rim.push_back(at(i, 0));
  const std::uint32_t hub = vertex({0.5 * (x.front() + x.back()), bottom, 0.5 * (z.front() + z.back())});
  const auto foot = static_cast<std::uint32_t>(geometry_.positions.size());
  for (std::uint32_t upper : rim) {
    const glm::vec3 above = geometry_.positions[upper];
    vertex({above.x, bottom, above.z});
  }
  for (std::uint32_t k = 0; k < rim.size(); ++k) {
    const auto next = static_cast<std::uint32_t>((k + 1) % rim.size());
    quad(rim[k], foot + k, foot + next, rim[next]);
    triangle(hub, foot + next, foot + k);
  }
}

void arc(Path& path, glm::dvec2 centre, double radius, double from, double to, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    path.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
}

Path circle(glm::dvec2 centre, double radius, int steps) {
  Path path;
  arc(path, centre, radius, 0.0, 2.0 * std::numbers::pi, steps);
  path.pop_back();
  return path;
}

void bar(Modeller& model, const Plane& plane, const Path& path, bool closed, double width, double depth) {
  static constexpr std::array<glm::dvec2, 8> k_profile = {{{0.5, -0.2},
                                                           {0.5, 0.2},
                                                           {0.15, 0.5},
                                                           {-0.15, 0.5},
                                                           {-0.5, 0.2},
                                                           {-0.5, -0.2},
                                                           {-0.15, -0.5},
                                                           {0.15, -0.5}}};
  const std::size_t count = path.size(), sides = k_profile.size();
  std::vector<std::array<std::uint32_t, 8>> rings(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 before = closed || i > 0 ? path[i] - path[(i + count - 1) % count] : path[1] - path[0];
    const glm::dvec2 after = closed || i + 1 < count ? path[(i + 1) % count] - path[i] : before;
    const glm::dvec2 a = glm::normalize(before), b = glm::normalize(after);
    // The mitre: longer than the bar is wide, but not spiky at cusps.
    const glm::dvec2 bisector = glm::normalize(a + b);
    const glm::dvec2 side = glm::dvec2(-bisector.y, bisector.x) / std::max(glm::dot(bisector, a), 0.6);
    for (std::size_t k = 0; k < sides; ++k) {
      const glm::dvec2 at = path[i] + side * (width * k_profile[k].x);
      rings[i][k] = model.vertex(plane.at(at.x, at.y, depth * k_profile[k].y));
    }
  }
  for (std::size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
    const auto &ring = rings[i], &next = rings[(i + 1) % count];
    for (std::size_t k = 0; k < sides; ++k)
      model.quad(ring[k], ring[(k + 1) % sides], next[(k + 1) % sides], next[k]);
  }
  if (closed) return;
  for (std::size_t k = 1; k + 1 < sides; ++k) {
    model.triangle(rings.front()[0], rings.front()[k + 1], rings.front()[k]);
    model.triangle(rings.back()[0], rings.back()[k], rings.back()[k + 1]);
  }
}

}  // namespace airlight::scene
