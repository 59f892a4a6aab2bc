#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/builtin_internal.h"

// A wrought-iron gate between two stone pillars, with a lamp behind it. Every part is a closed solid.

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_half_width = 1.9;                            // of the gate, between the pillars [m]
constexpr double k_low = 0.18, k_waist = 0.95, k_frieze = 1.2;  // heights of the straight rails [m]

/// Height of the arched top rail [m].
double top(double x) {
  return 1.62 + 0.55 * std::pow(std::cos(0.5 * k_pi * x / k_half_width), 2.0);
}

/// A spiral that begins at `from` of its centre and winds inwards.
void spiral(Path& path, glm::dvec2 centre, double radius, double from, double turns, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double part = static_cast<double>(i) / steps, angle = from + 2.0 * k_pi * turns * part;
    path.push_back(centre + radius * (1.0 - 0.75 * part) * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
}

/// An S of two spirals about `middle`; `hand` is 1 or, mirrored, −1.
void scroll(Modeller& model, const Plane& plane, glm::dvec2 middle, double height, double hand) {
  const double radius = 0.25 * height;
  Path lower, path;
  spiral(lower, {0.0, -radius}, radius, 0.5 * k_pi, -1.4, 26);
  for (glm::dvec2 p : lower) path.insert(path.begin(), {hand * p.x, p.y});
  path.pop_back();
  for (glm::dvec2 p : lower) path.push_back({-hand * p.x, -p.y});
  for (glm::dvec2& p : path) p += middle;
  bar(model, plane, path, false, 0.018, 0.03);
}

}  // namespace

Scene make_fence() {
  Scene scene;
  scene.name = "fence";
  Modeller model(scene.geometry);
  const Plane gate = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};

  model.paint({0.16f, 0.15f, 0.13f});
  model.box({-30.0, -0.5, -30.0}, {30.0, 0.0, 30.0});
  model.paint({0.36f, 0.33f, 0.29f});
  for (double side : {-1.0, 1.0}) {
    const double x = side * (k_half_width + 0.3);
    model.box({x - 0.34, -0.1, -0.34}, {x + 0.34, 0.25, 0.34});
    model.box({x - 0.28, 0.2, -0.28}, {x + 0.28, 2.0, 0.28});
    model.box({x - 0.36, 1.95, -0.36}, {x + 0.36, 2.1, 0.36});
    model.sphere({x, 2.32, 0.0}, 0.26, 10);
    // A low wall with a plain railing goes on beyond the pillar.
    model.box({std::min(x, side * 12.0), -0.1, -0.2}, {std::max(x, side * 12.0), 0.55, 0.2});
    for (int i = 0; i < 40; ++i)
      bar(model, gate, {{side * (2.65 + 0.22 * i), 0.45}, {side * (2.65 + 0.22 * i), 1.6}}, false, 0.022,
          0.022);
    for (double y : {0.7, 1.5}) bar(model, gate, {{x, y}, {side * 11.6, y}}, false, 0.03, 0.04);
  }

  // Rails.
  model.paint({0.05f, 0.05f, 0.055f});
  for (double y : {k_low, k_waist, k_frieze})
    bar(model, gate, {{-k_half_width - 0.1, y}, {k_half_width + 0.1, y}}, false, 0.036, 0.044);
  Path arch;
  for (int i = 0; i <= 48; ++i) {
    const double x = k_half_width * (i - 24) / 23.0;
    arch.push_back({x, top(std::clamp(x, -k_half_width, k_half_width))});
  }
  bar(model, gate, arch, false, 0.036, 0.044);

  // Pickets with spears, and between each two of them a ring and two scrolls.
  constexpr int k_gaps = 18;
  constexpr double k_gap = 2.0 * k_half_width / k_gaps;
  constexpr std::array<glm::dvec2, 7> k_spear = {{{0.012, 0.0},
                                                  {0.028, 0.02},
                                                  {0.014, 0.045},
                                                  {0.02, 0.07},
                                                  {0.034, 0.11},
                                                  {0.02, 0.18},
                                                  {0.002, 0.25}}};
  for (int i = 0; i <= k_gaps; ++i) {
    const double x = k_half_width * (2.0 * i / k_gaps - 1.0), crown = top(x) + 0.06;
    bar(model, gate, {{x, 0.06}, {x, crown + 0.01}}, false, 0.028, 0.028);
    model.turned({x, crown, 0.0}, k_spear, 8);
    if (i == k_gaps) break;
    const double middle = x + 0.5 * k_gap;
    bar(model, gate, circle({middle, 0.5 * (k_waist + k_frieze)}, 0.5 * k_gap - 0.012, 28), true, 0.016,
        0.026);
    scroll(model, gate, {middle, 0.5 * (k_low + k_waist)}, 0.36, i % 2 == 0 ? 1.0 : -1.0);
  }

  scene.cameras.push_back({"road", {-2.2, 0.75, 3.0}, {0.35, 1.2, -0.2}, {0.0, 1.0, 0.0}, 52.0});
  scene.lights.push_back(point_light("lamp", {1.1, 1.7, -0.6}, glm::vec3(1.0f, 0.78f, 0.53f) * 14.0f));
  scene.medium.sigma_s = glm::vec3(0.12f);
  scene.exposure = 1.8f;
  return scene;
}

}  // namespace airlight::scene
