#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "scene/builtin_internal.h"

// The default scene: light falls through gothic tracery into a dark hall.
//
// Every part is a closed solid that reaches into its neighbours, so no light leaks at a seam. The tracery
// follows the rule of the masons: an equilateral arch holds two of half its width and a circle that touches
// all three, and each of those two is divided the same way again.

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;

// The hall: inner faces of its walls [m].
constexpr double k_half_width = 6.0, k_height = 11.0, k_back = 11.0, k_front = -8.0;
constexpr double k_wall = 1.0;
// Across a wall, from its inner face: the tracery stands in the outer part of an opening, which is straight;
// from k_splay on it widens towards the hall.
constexpr double k_tracery = -0.7, k_splay = -0.4, k_widening = 0.45;

/// A pointed arch over the span from −half_width to +half_width, from its left foot to its right one.
Path pointed_arch(glm::dvec2 middle, double half_width, double height, int steps) {
  // Each arc's centre lies on the springing line, where it sees foot and apex equally far.
  const double offset = (height * height - half_width * half_width) / (2.0 * half_width);
  const double radius = half_width + offset, end = std::atan2(height, offset);
  Path path;
  arc(path, middle + glm::dvec2(offset, 0.0), radius, k_pi, k_pi - end, steps);
  path.pop_back();
  arc(path, middle - glm::dvec2(offset, 0.0), radius, end, 0.0, steps);
  return path;
}

/// `lobes` arcs inside a circle, which they touch, meeting in cusps.
/// @param reach distance of the lobes' centres from the middle, as a part of the radius
Path foil(glm::dvec2 middle, double radius, int lobes, double reach, double turn, int steps) {
  const double distance = reach * radius, lobe = radius - distance, half = k_pi / lobes;
  // Neighbouring lobes meet on the ray between their centres.
  const double along = distance * std::cos(half), across = distance * std::sin(half);
  const double cusp = along + std::sqrt(lobe * lobe - across * across);
  const double opening = std::atan2(cusp * std::sin(half), cusp * std::cos(half) - distance);
  Path path;
  for (int i = 0; i < lobes; ++i) {
    const double towards = turn + 2.0 * half * i;
    const glm::dvec2 centre = middle + distance * glm::dvec2(std::cos(towards), std::sin(towards));
    arc(path, centre, lobe, towards - opening, towards + opening, steps);
    path.pop_back();  // the cusp begins the next lobe
  }
  return path;
}

/// An opening of a wall under an equilateral arch [m].
struct Opening {
  double x, half_width, sill, spring;
};

constexpr int k_arch_steps = 24;

/// An outer wall with openings: a closed manifold, its two faces cut into upright strips that share their
/// corners.
///
/// @param plane its inner face; w points into the hall
/// @param openings from left to right
void pierced_wall(Modeller& model, const Plane& plane, double left_end, double right_end,
                  std::span<const Opening> openings) {
  constexpr double k_bottom = -k_wall, k_top = k_height + k_wall;
  // Corners on one upright line: bottom, sill, arch, top. The wall's own ends have but two.
  using Column = std::array<std::uint32_t, 4>;
  using Columns = std::vector<std::vector<Column>>;  // of the left end, of each opening, of the right end

  const auto columns_at = [&](double z, double widening) {
    Columns columns;
    const auto vertex = [&](double x, double y) { return model.vertex(plane.at(x, y, z)); };
    const auto end = [&](double x) {
      const std::uint32_t bottom = vertex(x, k_bottom), top = vertex(x, k_top);
      columns.push_back({{bottom, bottom, top, top}});
    };
    end(left_end);
    for (const Opening& o : openings) {
      // A wider arch has the same centres.
      const double half_width = o.half_width + widening, radius = 2.0 * o.half_width + widening;
      const double height = std::sqrt(radius * radius - o.half_width * o.half_width);
      columns.emplace_back();
      for (glm::dvec2 p : pointed_arch({o.x, o.spring}, half_width, height, k_arch_steps))
        columns.back().push_back(
            {vertex(p.x, k_bottom), vertex(p.x, o.sill - widening), vertex(p.x, p.y), vertex(p.x, k_top)});
    }
    end(right_end);
    return columns;
  };

  // Seen from the hall; the outer face is turned round.
  const auto face = [&](const Columns& columns, double z, double widening, bool turned) {
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      turned ? model.triangle(a, c, b) : model.triangle(a, b, c);
    };
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      triangle(a, b, c);
      triangle(a, c, d);
    };
    for (std::size_t i = 0; i < columns.size(); ++i) {
      // Under and over an opening.
      for (std::size_t j = 0; j + 1 < columns[i].size(); ++j) {
        const Column &left = columns[i][j], &right = columns[i][j + 1];
        quad(left[0], right[0], right[1], left[1]);
        quad(left[2], right[2], right[3], left[3]);
      }
      if (i + 1 == columns.size()) continue;
      // The full height between two openings, as a fan that takes up the corners of both.
      const Column &left = columns[i].back(), &right = columns[i + 1].front();
      std::vector<std::uint32_t> outline = {left[3],  left[2],  left[1],  left[0],
                                            right[0], right[1], right[2], right[3]};
      outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
      const double from = i == 0 ? left_end : openings[i - 1].x + openings[i - 1].half_width + widening;
      const double to = i == openings.size() ? right_end : openings[i].x - openings[i].half_width - widening;
      const std::uint32_t hub = model.vertex(plane.at(0.5 * (from + to), 0.5 * k_height, z));
      for (std::size_t k = 0; k < outline.size(); ++k)
        triangle(hub, outline[k], outline[(k + 1) % outline.size()]);
    }
  };
  const Columns outside = columns_at(-k_wall, 0.0), splay = columns_at(k_splay, 0.0);
  const Columns inside = columns_at(0.0, k_widening);
  face(outside, -k_wall, 0.0, true);
  face(inside, 0.0, k_widening, false);

  // The sides of the openings, straight where the tracery stands and then splayed.
  const auto join = [&](const std::vector<Column>& far, const std::vector<Column>& near) {
    for (std::size_t j = 0; j + 1 < far.size(); ++j) {
      model.quad(far[j][1], near[j][1], near[j + 1][1], far[j + 1][1]);
      model.quad(far[j][2], far[j + 1][2], near[j + 1][2], near[j][2]);
    }
    model.quad(far.front()[1], far.front()[2], near.front()[2], near.front()[1]);
    model.quad(far.back()[1], near.back()[1], near.back()[2], far.back()[2]);
  };
  for (std::size_t i = 1; i <= openings.size(); ++i) {
    join(outside[i], splay[i]);
    join(splay[i], inside[i]);
  }

  // The edges of the wall.
  std::vector<Column> far, near;
  for (const auto& columns : outside) far.insert(far.end(), columns.begin(), columns.end());
  for (const auto& columns : inside) near.insert(near.end(), columns.begin(), columns.end());
  for (std::size_t j = 0; j + 1 < far.size(); ++j) {
    model.quad(far[j][0], far[j + 1][0], near[j + 1][0], near[j][0]);
    model.quad(far[j][3], near[j][3], near[j + 1][3], far[j + 1][3]);
  }
  model.quad(far.front()[0], near.front()[0], near.front()[3], far.front()[3]);
  model.quad(far.back()[0], far.back()[3], near.back()[3], near.back()[0]);
}

/// An equilateral arch of bars, divided `levels` times, over `middle` on the springing line.
void tracery(Modeller& model, const Plane& plane, glm::dvec2 middle, double half_width, double sill,
             int levels, double width) {
  const double depth = 2.0 * width;
  Path frame = pointed_arch(middle, half_width, std::sqrt(3.0) * half_width, 32);
  frame.insert(frame.begin(), {middle.x - half_width, sill});
  frame.push_back({middle.x + half_width, sill});
  bar(model, plane, frame, false, width, depth);
  if (levels == 0) {
    // A lancet ends in a cusped head.
    Path head;
    const double a = half_width;
    arc(head, middle + glm::dvec2(-0.42 * a, 0.3 * a), 0.58 * a, k_pi * 1.1, k_pi * 0.36, 10);
    arc(head, middle + glm::dvec2(0.0, 0.99 * a), 0.41 * a, k_pi * 1.1, -k_pi * 0.1, 14);
    arc(head, middle + glm::dvec2(0.42 * a, 0.3 * a), 0.58 * a, k_pi * 0.64, -k_pi * 0.1, 10);
    bar(model, plane, head, false, 0.6 * width, 0.6 * depth);
    return;
  }

  const double quarter = 0.5 * half_width;
  tracery(model, plane, middle - glm::dvec2(quarter, 0.0), quarter, sill, levels - 1, 0.7 * width);
  tracery(model, plane, middle + glm::dvec2(quarter, 0.0), quarter, sill, levels - 1, 0.7 * width);

  // The circle between them touches both and the arch above: with a span of 2, its radius is 1/2 and its
  // middle √5/2 above the springing line.
  const double radius = quarter;
  const glm::dvec2 rose = middle + glm::dvec2(0.0, 0.5 * std::sqrt(5.0) * half_width);
  bar(model, plane, circle(rose, radius, 64), true, 0.8 * width, 0.8 * depth);
  if (levels == 1) {
    bar(model, plane, foil(rose, radius, 4, 0.52, 0.25 * k_pi, 14), true, 0.5 * width, 0.5 * depth);
    return;
  }
  constexpr int k_petals = 8;
  bar(model, plane, foil(rose, radius, k_petals, 0.71, 0.0, 10), true, 0.45 * width, 0.6 * depth);
  bar(model, plane, circle(rose, 0.3 * radius, 32), true, 0.45 * width, 0.6 * depth);
  bar(model, plane, foil(rose, 0.3 * radius, 4, 0.52, 0.25 * k_pi, 8), true, 0.2 * width, 0.3 * depth);
  for (int i = 0; i < k_petals; ++i) {
    const double angle = 2.0 * k_pi * (i + 0.5) / k_petals;
    const glm::dvec2 along(std::cos(angle), std::sin(angle));
    bar(model, plane, {rose + 0.3 * radius * along, rose + 0.74 * radius * along}, false, 0.35 * width,
        0.5 * depth);
  }
}

/// A column of eight clustered shafts on a plinth, with a capital.
void column(Modeller& model, double x, double z) {
  constexpr int k_sides = 48;
  struct Ring {
    double radius, y, lobes;
  };
  constexpr std::array<Ring, 13> k_rings = {{{0.62, -0.2, 0.0},
                                             {0.62, 0.3, 0.0},
                                             {0.52, 0.36, 0.0},
                                             {0.54, 0.46, 0.0},
                                             {0.44, 0.56, 0.0},
                                             {0.4, 0.62, 0.1},
                                             {0.4, 4.9, 0.1},
                                             {0.47, 4.95, 0.0},
                                             {0.47, 5.03, 0.0},
                                             {0.42, 5.08, 0.0},
                                             {0.62, 5.5, 0.0},
                                             {0.66, 5.5, 0.0},
                                             {0.66, 5.8, 0.0}}};
  std::array<std::array<std::uint32_t, k_sides>, k_rings.size()> rings;
  for (std::size_t i = 0; i < k_rings.size(); ++i) {
    for (std::size_t k = 0; k < k_sides; ++k) {
      const double angle = 2.0 * k_pi * static_cast<double>(k) / k_sides;
      const double radius =
          k_rings[i].radius * (1.0 + k_rings[i].lobes * (2.0 * std::abs(std::cos(4.0 * angle)) - 1.0));
      rings[i][k] = model.vertex({x + radius * std::sin(angle), k_rings[i].y, z + radius * std::cos(angle)});
    }
  }
  const std::uint32_t foot = model.vertex({x, k_rings.front().y, z}),
                      head = model.vertex({x, k_rings.back().y, z});
  for (std::size_t k = 0; k < k_sides; ++k) {
    const std::size_t next = (k + 1) % k_sides;
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
      model.quad(rings[i][k], rings[i][next], rings[i + 1][next], rings[i + 1][k]);
    model.triangle(foot, rings.front()[next], rings.front()[k]);
    model.triangle(head, rings.back()[k], rings.back()[next]);
  }
}

/// A pew across the hall, from x to x + width, facing the window.
void pew(Modeller& model, double x, double z, double width) {
  model.box({x, 0.40, z - 0.42}, {x + width, 0.45, z}, 0.0);         // seat
  model.box({x, 0.30, z - 0.04}, {x + width, 0.88, z + 0.01}, 0.0);  // back
  model.box({x, 0.86, z - 0.08}, {x + width, 0.93, z + 0.05}, 0.0);  // rail
  for (double end : {x - 0.03, x + width - 0.03})
    model.box({end, -0.05, z - 0.45}, {end + 0.06, 0.98, z + 0.06}, 0.0);
}

}  // namespace

Scene make_window() {
  Scene scene;
  scene.name = "window";
  Modeller model(scene.geometry);

  // The shell. Its parts overlap at the edges; floor and ceiling end inside the pierced walls.
  constexpr double k_side = k_half_width + k_wall, k_end = k_back + k_wall, k_middle = 0.5 * k_wall;
  const Plane front = {{0.0, 0.0, k_front}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const std::array<Opening, 3> openings = {
      {{-4.0, 0.55, 2.2, 5.2}, {0.0, 2.3, 1.4, 5.0}, {4.0, 0.55, 2.2, 5.2}}};
  model.paint({0.24f, 0.21f, 0.18f});
  model.box({-k_side + k_middle, -k_wall, k_front - k_middle}, {k_side, 0.0, k_end});
  model.paint({0.34f, 0.31f, 0.27f});
  pierced_wall(model, front, -k_side, k_side, openings);
  model.box({-k_side, -k_wall, k_front - k_middle}, {-k_half_width, k_height + k_wall, k_end});
  model.box({k_half_width, -k_wall, k_front - k_middle}, {k_side, k_height + k_wall, k_end});
  model.box({-k_side + k_middle, -k_wall, k_back}, {k_side, k_height + k_wall, k_end});
  model.paint({0.25f, 0.19f, 0.14f});
  model.box({-k_side + k_middle, k_height, k_front - k_middle}, {k_side, k_height + k_wall, k_end});

  // Tracery, and the bars that hold the (missing) glass.
  model.paint({0.4f, 0.37f, 0.33f});
  Plane glazing = front;
  glazing.origin += k_tracery * front.w;
  for (const Opening& o : openings) {
    const bool great = o.half_width > 1.0;
    tracery(model, glazing, {o.x, o.spring}, o.half_width, o.sill - 0.1, great ? 2 : 1, great ? 0.24 : 0.16);
    for (double y = o.sill + 0.8; y < o.spring + 0.1; y += 0.8)
      bar(model, glazing, {{o.x - o.half_width - 0.1, y}, {o.x + o.half_width + 0.1, y}}, false, 0.035,
          0.035);
  }

  // Columns, the arches between them and those across the nave.
  model.paint({0.36f, 0.33f, 0.29f});
  constexpr double k_aisle = 4.8, k_bay = 3.8, k_first = -5.0;
  for (double x : {-k_aisle, k_aisle}) {
    const Plane arcade = {{x, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}};
    for (int i = 0; i < 4; ++i) {
      const double z = k_first + k_bay * i;
      column(model, x, z);
      if (i < 3)
        bar(model, arcade, pointed_arch({z + 0.5 * k_bay, 5.7}, 0.5 * k_bay, 2.4, 16), false, 0.5, 0.6);
    }
  }
  for (int i = 0; i < 4; ++i) {
    const Plane rib = {{0.0, 0.0, k_first + k_bay * i}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    bar(model, rib, pointed_arch({0.0, 5.7}, k_aisle, 5.0, 28), false, 0.45, 0.5);
  }

  // Steps before the window, and pews.
  model.box({-2.8, -0.1, k_front - k_middle}, {2.8, 0.16, -5.9});
  model.box({-2.4, -0.1, k_front - k_middle}, {2.4, 0.32, -6.5});
  model.paint({0.3f, 0.2f, 0.12f});
  for (int row = 0; row < 3; ++row) {
    const double z = -3.6 + 1.25 * row;
    pew(model, -3.6, z, 2.6);
    pew(model, 1.0, z, 2.6);
  }

  scene.cameras.push_back({"nave", {-3.1, 2.5, 4.9}, {2.1, 3.5, -8.0}, {0.0, 1.0, 0.0}, 62.0});
  scene.lights.push_back(point_light("lamp", {-4.5, 13.0, -20.0}, glm::vec3(1.0f, 0.84f, 0.6f) * 52000.0f));
  scene.medium.sigma_s = glm::vec3(0.05f);
  scene.exposure = 1.0f;
  return scene;
}

}  // namespace airlight::scene
