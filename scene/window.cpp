#include <array>

#include "scene/gothic.h"

// The default scene: light falls through gothic tracery into a dark hall.
//
// Every part is a closed solid that reaches into its neighbours, so no light leaks at a seam.

namespace airlight::scene {
namespace {

// The hall: inner faces of its walls [m].
constexpr double k_half_width = 6.0, k_height = 11.0, k_back = 11.0, k_front = -8.0;
constexpr double k_wall = 1.0;
// Across a wall, from its inner face: the tracery stands in the outer part of an opening, which is straight.
constexpr double k_tracery = -0.7;

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
  pierced_wall(model, {front, -k_side, k_side, -k_wall, k_height + k_wall}, openings);
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
