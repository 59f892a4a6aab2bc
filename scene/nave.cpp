#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/gothic.h"
#include "scene/view_fields.h"

// The nave of a church, seen along its axis: a low sun shines through the tall windows of one aisle, a little
// from ahead, and its shafts slant through arcade and nave to the pews.
//
// Every part is a closed solid that reaches into its neighbours, so no light leaks at a seam.

namespace airlight::scene {
namespace {

// Inner faces of the walls, and of the arcades between nave and aisles [m].
constexpr double k_side = 8.6, k_nave = 4.5, k_east = -32.0, k_west = 10.0;
constexpr double k_wall = 1.0, k_arcade = 0.7;
constexpr double k_ceiling = 11.3, k_ridge = 16.2;  // of the aisles, of the nave [m]
constexpr int k_bays = 7;
constexpr double k_bay = (k_west - k_east) / k_bays;  // length [m]
constexpr double k_tracery = -0.65;                   // across a wall, from its inner face [m]

/// The middle of a bay, counted from the east, or of the column between two.
double along(double bay) {
  return k_east + k_bay * bay;
}

void glaze(Modeller& model, Plane plane, const Opening& o, int levels, double width) {
  plane.origin += k_tracery * plane.w;
  tracery(model, plane, {o.x, o.spring}, o.half_width, o.sill - 0.1, levels, width);
  for (double y = o.sill + 0.9; y < o.spring + 0.1; y += 0.9)
    bar(model, plane, {{o.x - o.half_width - 0.1, y}, {o.x + o.half_width + 0.1, y}}, false, 0.035, 0.035);
}

/// One side of the church: an arcade, and the outer wall of its aisle.
/// @param hand 1 for the south, at +X, −1 for the north
void add_side(Modeller& model, double hand) {
  // u × v = w, so that openings run east or west.
  const auto wall_at = [&](double x) {
    return Plane{{hand * x, 0.0, 0.0}, {0.0, 0.0, hand}, {0.0, 1.0, 0.0}, {-hand, 0.0, 0.0}};
  };
  const auto wall = [&](double x, double thickness) {
    const double a = hand * (k_east - 0.5 * k_wall), b = hand * (k_west + 0.5 * k_wall);
    return Wall{.plane = wall_at(x),
                .left = std::min(a, b),
                .right = std::max(a, b),
                .bottom = -k_wall,
                .top = k_ceiling + 0.9,
                .thickness = thickness};
  };
  std::vector<Opening> windows, arches;
  for (int i = 0; i < k_bays; ++i) {
    const double x = hand * along((hand > 0.0 ? i : k_bays - 1 - i) + 0.5);
    windows.push_back({x, 1.05, 2.8, 8.4});
    arches.push_back({x, 2.7, -0.5, 6.2});
  }

  model.paint({0.38f, 0.35f, 0.3f});
  const Wall outer = wall(k_side, k_wall);
  pierced_wall(model, outer, windows);
  Wall arcade = wall(k_nave, k_arcade);
  arcade.splay = -0.2;
  arcade.widening = 0.12;
  pierced_wall(model, arcade, arches);
  model.paint({0.42f, 0.39f, 0.34f});
  // No sun falls through the north windows: theirs is plain.
  for (const Opening& o : windows) glaze(model, outer.plane, o, hand > 0.0 ? 1 : 0, 0.17);

  // Columns of the arcade, and the arches from them to the outer wall.
  model.paint({0.4f, 0.37f, 0.32f});
  const double middle = hand * (k_nave + 0.5 * k_arcade);
  for (int i = 0; i <= k_bays; ++i) {
    column(model, middle, along(i), 1.3, 0.5);
    const Plane across = {{0.0, 0.0, along(i)}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const double half_width = 0.5 * (k_side - std::abs(middle));
    bar(model, across, pointed_arch({hand * (k_side - half_width), 6.2}, half_width, k_ceiling - 6.3, 20),
        false, 0.4, 0.5);
    bar(model, across, {{hand * k_side, -0.1}, {hand * k_side, 6.4}}, false, 0.6, 0.6);
  }
  model.paint({0.25f, 0.18f, 0.12f});
  const double inner = hand * k_nave, far = hand * (k_side + 0.5 * k_wall);
  model.box({std::min(middle, far), k_ceiling, k_east - 0.4},
            {std::max(middle, far), k_ceiling + 0.7, k_west + 0.4});
  for (double bay = 0.25; bay < k_bays; bay += 0.25)
    model.box({std::min(inner, far), k_ceiling - 0.25, along(bay) - 0.1},
              {std::max(inner, far), k_ceiling + 0.3, along(bay) + 0.1});
}

}  // namespace

Scene make_nave() {
  Scene scene;
  scene.name = "nave";
  Modeller model(scene.geometry);
  model.paint({0.3f, 0.27f, 0.23f});
  model.box({-k_side - 0.5, -k_wall, k_east - 0.5}, {k_side + 0.5, 0.0, k_west + 0.5});
  for (double hand : {1.0, -1.0}) add_side(model, hand);

  // The east end, with the great window; the west wall behind the beholder.
  model.paint({0.38f, 0.35f, 0.3f});
  const Plane east = {{0.0, 0.0, k_east}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const std::array<Opening, 3> lights = {
      {{-6.75, 0.8, 3.2, 7.6}, {0.0, 2.6, 4.4, 9.2}, {6.75, 0.8, 3.2, 7.6}}};
  pierced_wall(model, {east, -k_side - 0.9, k_side + 0.9, -k_wall, k_ridge + 1.0}, lights);
  model.box({-k_side - 0.9, -k_wall, k_west}, {k_side + 0.9, k_ridge + 1.0, k_west + k_wall});
  model.paint({0.42f, 0.39f, 0.34f});
  for (const Opening& o : lights)
    glaze(model, east, o, o.half_width > 1.0 ? 2 : 0, o.half_width > 1.0 ? 0.26 : 0.15);

  // The vault of the nave, its ribs, and the shafts on the wall that carry them.
  const double half_width = k_nave + 0.5 * k_arcade;
  const Path arch = pointed_arch({0.0, k_ceiling}, half_width, k_ridge - k_ceiling, 32);
  const auto across = [&](double z) {
    return Plane{{0.0, 0.0, z}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  };
  bar(model, across(0.5 * (k_east + k_west)), arch, false, 0.5, k_west - k_east + 1.6);
  model.paint({0.4f, 0.37f, 0.32f});
  for (int i = 0; i <= k_bays; ++i) {
    bar(model, across(along(i)), arch, false, 1.0, 0.5);
    for (double hand : {1.0, -1.0})
      bar(model, across(along(i)), {{hand * k_nave, 6.0}, {hand * k_nave, k_ceiling + 0.3}}, false, 0.5, 0.5);
  }

  // The choir's steps and the altar; pews on both sides of the aisle.
  model.box({-k_nave, -0.1, k_east - 0.4}, {k_nave, 0.17, along(1.5)});
  model.box({-k_nave + 0.3, -0.1, k_east - 0.4}, {k_nave - 0.3, 0.34, along(1.5) - 0.4});
  model.box({-1.6, 0.3, along(0.6)}, {1.6, 1.4, along(0.6) + 0.9});
  model.paint({0.27f, 0.18f, 0.11f});
  for (double z = along(2.0); z < along(6.2); z += 1.25) {
    pew(model, -3.6, z, 2.6);
    pew(model, 1.0, z, 2.6);
  }

  scene.cameras.push_back({"west", {-2.9, 2.6, 6.5}, {1.6, 4.8, -20.0}, {0.0, 1.0, 0.0}, 64.0});
  scene.lights.push_back(
      sun("sun", direction_of_angles({125.0, 22.0}), glm::vec3(1.0f, 0.82f, 0.58f) * 100.0f));
  scene.medium.sigma_s = glm::vec3(0.02f);
  scene.medium.phase = PhaseFunction::henyey_greenstein;
  scene.medium.g = 0.5f;
  scene.exposure = 0.8f;
  return scene;
}

}  // namespace airlight::scene
