#include "scene/gothic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

// The tracery follows the rule of the masons: an equilateral arch holds two of half its width and a circle
// that touches all three, and each of those two is divided the same way again.

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr int k_arch_steps = 24;

}  // namespace

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

void pierced_wall(Modeller& model, const Wall& wall, std::span<const Opening> openings) {
  const Plane& plane = wall.plane;
  // Corners on one upright line: bottom, sill, arch, top. The wall's own ends have but two.
  using Column = std::array<std::uint32_t, 4>;
  using Columns = std::vector<std::vector<Column>>;  // of the left end, of each opening, of the right end

  const auto columns_at = [&](double z, double widening) {
    Columns columns;
    const auto vertex = [&](double x, double y) { return model.vertex(plane.at(x, y, z)); };
    const auto end = [&](double x) {
      const std::uint32_t bottom = vertex(x, wall.bottom), top = vertex(x, wall.top);
      columns.push_back({{bottom, bottom, top, top}});
    };
    end(wall.left);
    for (const Opening& o : openings) {
      // A wider arch has the same centres.
      const double half_width = o.half_width + widening, radius = 2.0 * o.half_width + widening;
      const double height = std::sqrt(radius * radius - o.half_width * o.half_width);
      columns.emplace_back();
      for (glm::dvec2 p : pointed_arch({o.x, o.spring}, half_width, height, k_arch_steps))
        columns.back().push_back({vertex(p.x, wall.bottom), vertex(p.x, o.sill - widening), vertex(p.x, p.y),
                                  vertex(p.x, wall.top)});
    }
    end(wall.right);
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
      const double from = i == 0 ? wall.left : openings[i - 1].x + openings[i - 1].half_width + widening;
      const double to = i == openings.size() ? wall.right : openings[i].x - openings[i].half_width - widening;
      const std::uint32_t hub = model.vertex(plane.at(0.5 * (from + to), 0.5 * (wall.bottom + wall.top), z));
      for (std::size_t k = 0; k < outline.size(); ++k)
        triangle(hub, outline[k], outline[(k + 1) % outline.size()]);
    }
  };
  const Columns outside = columns_at(-wall.thickness, 0.0), splay = columns_at(wall.splay, 0.0);
  const Columns inside = columns_at(0.0, wall.widening);
  face(outside, -wall.thickness, 0.0, true);
  face(inside, 0.0, wall.widening, false);

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

void column(Modeller& model, double x, double z, double girth, double rise) {
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
  constexpr std::size_t k_shaft = 5;  // the ring at its foot
  const auto height = [&](std::size_t i) { return k_rings[i].y + (i > k_shaft ? rise : 0.0); };
  std::array<std::array<std::uint32_t, k_sides>, k_rings.size()> rings;
  for (std::size_t i = 0; i < k_rings.size(); ++i) {
    for (std::size_t k = 0; k < k_sides; ++k) {
      const double angle = 2.0 * k_pi * static_cast<double>(k) / k_sides;
      const double radius = girth * k_rings[i].radius *
                            (1.0 + k_rings[i].lobes * (2.0 * std::abs(std::cos(4.0 * angle)) - 1.0));
      rings[i][k] = model.vertex({x + radius * std::sin(angle), height(i), z + radius * std::cos(angle)});
    }
  }
  const std::uint32_t foot = model.vertex({x, height(0), z}),
                      head = model.vertex({x, height(k_rings.size() - 1), z});
  for (std::size_t k = 0; k < k_sides; ++k) {
    const std::size_t next = (k + 1) % k_sides;
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
      model.quad(rings[i][k], rings[i][next], rings[i + 1][next], rings[i + 1][k]);
    model.triangle(foot, rings.front()[next], rings.front()[k]);
    model.triangle(head, rings.back()[k], rings.back()[next]);
  }
}

void pew(Modeller& model, double x, double z, double width) {
  model.box({x, 0.40, z - 0.42}, {x + width, 0.45, z}, 0.0);         // seat
  model.box({x, 0.30, z - 0.04}, {x + width, 0.88, z + 0.01}, 0.0);  // back
  model.box({x, 0.86, z - 0.08}, {x + width, 0.93, z + 0.05}, 0.0);  // rail
  for (double end : {x - 0.03, x + width - 0.03})
    model.box({end, -0.05, z - 0.45}, {end + 0.06, 0.98, z + 0.06}, 0.0);
}

}  // namespace airlight::scene
