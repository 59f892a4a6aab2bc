#include "scene/shore.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Lines of a grid from −reach to reach, denser about the middle.
std::vector<double> lines(double reach, int count) {
  std::vector<double> at;
  for (int i = -count; i <= count; ++i) {
    const double part = static_cast<double>(i) / count;
    at.push_back(reach * part * (0.15 + 0.85 * part * part));
  }
  return at;
}

}  // namespace

void sea(Modeller& model, double reach, double swell) {
  const std::vector<double> grid = lines(reach, 60);
  model.slab(grid, grid, -6.0, [&](double x, double z) {
    const double far = std::hypot(x, z) / 60.0;
    return swell / (1.0 + far * far) *
           (0.5 * std::sin(0.31 * x + 0.53 * z) + 0.3 * std::sin(0.83 * z - 0.42 * x + 1.0) +
            0.2 * std::sin(1.31 * x + 0.9 * z + 2.0));
  });
}

void rock(Modeller& model, Random& random, glm::dvec3 foot, glm::dvec3 size) {
  constexpr int k_rings = 6;
  constexpr std::uint32_t k_sides = 13;
  std::array<std::array<std::uint32_t, k_sides>, k_rings> rings;
  const double turn = random.between(0.0, 2.0 * k_pi);
  std::array<double, k_sides> lean;  // a face that leans in below does so above
  for (double& part : lean) part = random.between(0.75, 1.2);
  for (int i = 0; i < k_rings; ++i) {
    const double part = static_cast<double>(i) / k_rings, width = std::sqrt(1.0 - part * part * 0.97);
    for (std::uint32_t k = 0; k < k_sides; ++k) {
      const double angle = turn + 2.0 * k_pi * (k + random.between(-0.25, 0.25)) / k_sides;
      const double out = width * lean[k] * random.between(0.86, 1.1);
      rings[static_cast<std::size_t>(i)][k] = model.vertex(
          foot + size * glm::dvec3(out * std::sin(angle), part + (i > 0 ? random.between(-0.06, 0.06) : 0.0),
                                   out * std::cos(angle)));
    }
  }
  const std::uint32_t bottom = model.vertex(foot);
  const std::uint32_t top = model.vertex(foot + glm::dvec3(0.0, size.y * random.between(0.93, 1.02), 0.0));
  for (std::uint32_t k = 0; k < k_sides; ++k) {
    const std::uint32_t next = (k + 1) % k_sides;
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
      model.quad(rings[i][k], rings[i][next], rings[i + 1][next], rings[i + 1][k]);
    model.triangle(bottom, rings.front()[next], rings.front()[k]);
    model.triangle(top, rings.back()[k], rings.back()[next]);
  }
}

void pole(Modeller& model, glm::dvec3 from, glm::dvec3 to, double radius, std::uint32_t sides) {
  model.rod(std::array{glm::dvec4(from, radius), glm::dvec4(to, radius)}, sides);
}

void rope(Modeller& model, glm::dvec3 from, glm::dvec3 to, double radius, double sag) {
  constexpr int k_pieces = 8;
  std::array<glm::dvec4, k_pieces + 1> path;
  for (int i = 0; i <= k_pieces; ++i) {
    const double part = static_cast<double>(i) / k_pieces;
    const glm::dvec3 at = glm::mix(from, to, part) - glm::dvec3(0.0, 4.0 * sag * part * (1.0 - part), 0.0);
    path[static_cast<std::size_t>(i)] = {at, radius};
  }
  model.rod(path, 4);
}

void hoop(Modeller& model, glm::dvec3 middle, double radius, double width, int steps) {
  const Plane level = {middle, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
  bar(model, level, circle({0.0, 0.0}, radius, steps), true, width, width);
}

void ship(Modeller& model, const Ship& ship) {
  const double c = std::cos(glm::radians(ship.heading)), s = std::sin(glm::radians(ship.heading));
  const double length = ship.length, beam = 0.125 * length, freeboard = 0.085 * length;
  // Forward, up, to starboard.
  const auto at = [&](double x, double y, double z) {
    return ship.at + glm::dvec3(c * x + s * z, y, c * z - s * x);
  };
  const auto half_width = [&](double part) {  // at the deck, from the stern, 0, to the bow, 1
    return beam * std::max(0.03, std::pow(std::sin(k_pi * (0.24 + 0.76 * part)), 0.7));
  };
  const auto deck = [&](double part) { return freeboard * (0.85 + 1.3 * std::pow(part - 0.4, 2.0)); };

  // Sections of the hull from stern to bow: down the starboard side, up the port side.
  constexpr int k_sections = 16;
  constexpr std::array<glm::dvec2, 4> k_side = {{{1.0, 1.0}, {1.04, 0.4}, {0.85, -0.35}, {0.3, -1.0}}};
  model.paint({0.08f, 0.075f, 0.08f});
  std::array<std::uint32_t, 2 * k_side.size()> ring, before;
  for (int i = 0; i <= k_sections; ++i) {
    const double part = static_cast<double>(i) / k_sections;
    for (std::size_t k = 0; k < k_side.size(); ++k) {
      const glm::dvec2 p = k_side[k];
      const double rake = 0.05 * length * part * part * p.y, x = length * (part - 0.5) + rake;
      const double y = p.y > 0.0 ? p.y * deck(part) : p.y * freeboard, z = p.x * half_width(part);
      ring[k] = model.vertex(at(x, y, z));
      ring[ring.size() - 1 - k] = model.vertex(at(x, y, -z));
    }
    const auto sides = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t k = 0; k < sides && i > 0; ++k)
      model.quad(before[k], before[(k + 1) % sides], ring[(k + 1) % sides], ring[k]);
    for (std::uint32_t k = 1; k + 1 < sides && (i == 0 || i == k_sections); ++k)
      i == 0 ? model.triangle(ring[0], ring[k + 1], ring[k]) : model.triangle(ring[0], ring[k], ring[k + 1]);
    before = ring;
  }
  const double middle = deck(0.4);
  model.paint({0.3f, 0.26f, 0.2f});
  const glm::dvec3 house = at(-0.28 * length, middle - 0.1, 0.0);
  const double wide = 0.5 * beam, high = 0.08 * length;
  model.box(house + glm::dvec3(-0.1 * length, 0.0, -wide), house + glm::dvec3(0.1 * length, high, wide),
            ship.heading);

  // Masts, and what they carry; ropes no thinner than what is seen some thirty metres away.
  model.paint({0.2f, 0.14f, 0.09f});
  const double thin = 0.022, stout = 0.012 * length;
  std::vector<glm::dvec3> heads;
  for (int mast = 0; mast < ship.masts; ++mast) {
    const double x = length * (ship.masts == 1 ? 0.08 : 0.3 - 0.5 * mast / (ship.masts - 1.0));
    const double height = ship.mast_height * (mast == 0 && ship.masts > 1 ? 0.94 : mast == 2 ? 0.8 : 1.0);
    const double part = x / length + 0.5, foot = deck(part) - 0.3;
    model.rod(
        std::array{glm::dvec4(at(x, foot, 0.0), stout), glm::dvec4(at(x, 0.55 * height, 0.0), 0.75 * stout),
                   glm::dvec4(at(x, height, 0.0), 0.3 * stout)},
        8);
    heads.push_back(at(x, 0.97 * height, 0.0));
    for (int yard = 0; yard < ship.yards; ++yard) {
      const double y = height * (0.42 + 0.46 * yard / std::max(ship.yards - 1.0, 1.0));
      const double reach = beam * (2.1 - 0.45 * yard);
      const double x_yard = x + 1.3 * stout;
      model.rod(std::array{glm::dvec4(at(x_yard, y, -reach), 0.25 * stout),
                           glm::dvec4(at(x_yard, y, 0.0), 0.5 * stout),
                           glm::dvec4(at(x_yard, y, reach), 0.25 * stout)},
                6);
      // The furled sail.
      model.rod(std::array{glm::dvec4(at(x_yard, y + 0.6 * stout, -0.85 * reach), 0.35 * stout),
                           glm::dvec4(at(x_yard, y + 0.9 * stout, 0.0), 0.95 * stout),
                           glm::dvec4(at(x_yard, y + 0.6 * stout, 0.85 * reach), 0.35 * stout)},
                6);
      for (double hand : {-1.0, 1.0})
        rope(model, at(x_yard, y, 0.95 * hand * reach),
             at(x, std::min(y + 0.17 * height, 0.97 * height), 0.0), thin);
    }
    if (ship.yards == 0) {
      const double aft = x - 0.34 * length;
      pole(model, at(x, foot + 0.12 * height, 0.0), at(aft, foot + 0.14 * height, 0.0), 0.5 * stout);
      pole(model, at(x, 0.62 * height, 0.0), at(aft + 0.06 * length, 0.8 * height, 0.0), 0.35 * stout);
      rope(model, at(aft, foot + 0.14 * height, 0.0), at(aft + 0.06 * length, 0.8 * height, 0.0), thin);
      model.rod(std::array{glm::dvec4(at(x - stout, foot + 0.16 * height, 0.0), 1.1 * stout),
                           glm::dvec4(at(aft + 0.03 * length, foot + 0.17 * height, 0.0), 0.5 * stout)},
                6);
    }
    // Shrouds, and the ratlines across them.
    const double top = height * (ship.yards > 0 ? 0.7 : 0.86);
    for (double hand : {-1.0, 1.0}) {
      constexpr int k_shrouds = 4;
      const auto shroud = [&](int i, double up) {
        const double x_foot = x - 0.04 * length + 0.027 * length * i;
        return glm::mix(
            at(x_foot, deck(x_foot / length + 0.5) - 0.1, 0.94 * hand * half_width(x_foot / length + 0.5)),
            at(x, top, 0.0), up);
      };
      for (int i = 0; i < k_shrouds; ++i) rope(model, shroud(i, 0.0), shroud(i, 1.0), thin);
      for (int step = 1; step < 12; ++step)
        pole(model, shroud(0, step / 13.0), shroud(k_shrouds - 1, step / 13.0), 0.6 * thin, 4);
    }
  }
  // The bowsprit, and stays from head to head.
  const glm::dvec3 sprit = at(0.68 * length, deck(1.0) + 0.1 * length, 0.0);
  model.rod(std::array{glm::dvec4(at(0.4 * length, deck(0.9) - 0.1, 0.0), 0.7 * stout),
                       glm::dvec4(sprit, 0.3 * stout)},
            6);
  rope(model, sprit, heads.front(), thin);
  rope(model, glm::mix(sprit, at(0.45 * length, deck(0.95), 0.0), 0.5),
       glm::mix(at(0.3 * length, 0.0, 0.0), heads.front(), 0.7), thin);
  for (std::size_t i = 0; i + 1 < heads.size(); ++i) {
    rope(model, heads[i], heads[i + 1], thin, 0.2);
    rope(model, heads[i], heads[i + 1] - glm::dvec3(0.0, 0.6 * ship.mast_height, 0.0), thin);
  }
  rope(model, heads.back(), at(-0.49 * length, deck(0.0) - 0.1, 0.0), thin);
}

}  // namespace airlight::scene
