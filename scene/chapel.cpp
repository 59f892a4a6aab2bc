#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/gothic.h"
#include "scene/view_fields.h"

// A chapel with stained glass: the sun falls through panes of many colours between leads, in coloured shafts
// to floor and wall. The panes of a window are one sheet, each of two triangles; where the arch does not show
// it, the sheet stands in the wall.
//
// The rest is made of closed solids that reach into their neighbours, so no light leaks at a seam.

namespace airlight::scene {
namespace {

// Inner faces of the walls, and the ceiling [m].
constexpr double k_side = 4.2, k_east = -13.0, k_west = 4.0, k_ceiling = 7.6, k_wall = 0.8;
constexpr int k_bays = 5;
constexpr double k_bay = (k_west - k_east) / k_bays;

// What a window is made of [m].
constexpr double k_glass = -0.55;  // across the wall, from its inner face
constexpr double k_pane = 0.3;     // a pane's width and height
constexpr double k_lead = 0.035;   // width of the leads

/// What each kind of glass lets through.
constexpr auto k_glasses = std::to_array<glm::vec3>({
    {0.90f, 0.05f, 0.03f},  // ruby, coloured with gold
    {0.04f, 0.12f, 0.85f},  // cobalt
    {0.95f, 0.55f, 0.05f},  // silver stain
    {0.05f, 0.60f, 0.16f},  // copper
    {0.50f, 0.08f, 0.70f},  // manganese
    {0.85f, 0.88f, 0.80f},  // white
});

/// Of a pane of a window, by its place from the middle and the sill: a ground of the window's own colour, on
/// it diamonds of another, white where their edges meet.
std::size_t glass_of(int column, int row, int columns, int window) {
  constexpr std::array<std::size_t, 5> k_grounds = {1, 0, 3, 4, 2}, k_diamonds = {2, 1, 2, 3, 0};
  constexpr std::size_t k_white = 5;
  const auto own = static_cast<std::size_t>(window);
  const int from_middle = std::abs(2 * column - (columns - 1)) / 2;
  const bool rises = (row - from_middle + 400) % 4 == 0, falls = (row + from_middle) % 4 == 0;
  if (rises && falls) return k_white;
  return rises || falls ? k_diamonds[own] : k_grounds[own];
}

/// The glass of an opening, up to a height, and its leads.
void glaze(Modeller& model, Geometry& geometry, const Plane& plane, const Opening& o, double top,
           int window) {
  const int columns = static_cast<int>(std::ceil(2.0 * o.half_width / k_pane)) + 1;
  const int rows = static_cast<int>(std::ceil((top - o.sill) / k_pane)) + 1;
  const double left = o.x - 0.5 * columns * k_pane, bottom = o.sill - 0.5 * k_pane;
  std::vector<std::uint32_t> corners;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column)
      corners.push_back(model.vertex(plane.at(left + column * k_pane, bottom + row * k_pane, k_glass)));
  const auto corner = [&](int column, int row) {
    return corners[static_cast<std::size_t>(row * (columns + 1) + column)];
  };
  const auto first = static_cast<std::uint32_t>(geometry.materials.size());
  for (const glm::vec3& glass : k_glasses)
    geometry.materials.push_back({.albedo = glm::vec3(0.02f), .transmittance = glass});
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      model.quad(corner(column, row), corner(column + 1, row), corner(column + 1, row + 1),
                 corner(column, row + 1));
      const auto glass = static_cast<std::uint32_t>(glass_of(column, row, columns, window));
      for (std::size_t i = 1; i <= 2; ++i)
        *(geometry.material_of_triangle.end() - static_cast<int>(i)) = first + glass;
    }

  model.paint(glm::vec3(0.05f));
  Plane leads = plane;
  leads.origin += k_glass * plane.w;
  for (int column = 1; column < columns; ++column) {
    const double x = left + column * k_pane;
    bar(model, leads, {{x, bottom}, {x, bottom + rows * k_pane}}, false, k_lead, k_lead);
  }
  for (int row = 1; row < rows; ++row) {
    const double y = bottom + row * k_pane;
    bar(model, leads, {{left, y}, {left + columns * k_pane, y}}, false, k_lead, k_lead);
  }
}

}  // namespace

Scene make_chapel() {
  Scene scene;
  scene.name = "chapel";
  Modeller model(scene.geometry);
  model.paint({0.55f, 0.52f, 0.47f});
  model.box({-k_side - 0.5, -k_wall, k_east - 0.5}, {k_side + 0.5, 0.0, k_west + 0.5});
  model.paint({0.62f, 0.58f, 0.52f});
  model.box({-k_side - k_wall, -k_wall, k_east - 0.5}, {-k_side, k_ceiling + 0.5, k_west + 0.5});
  model.box({-k_side - 0.5, -k_wall, k_east - k_wall}, {k_side + 0.5, k_ceiling + 0.5, k_east});
  model.box({-k_side - 0.5, -k_wall, k_west}, {k_side + 0.5, k_ceiling + 0.5, k_west + k_wall});

  // The south wall, at +X: u runs along −Z, so that w points into the hall.
  const Plane south = {{k_side, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}};
  std::vector<Opening> windows;
  for (int bay = 0; bay < k_bays; ++bay) windows.push_back({k_east + (bay + 0.5) * k_bay, 0.85, 1.6, 4.6});
  pierced_wall(model,
               {.plane = south,
                .left = k_east - 0.5,
                .right = k_west + 0.5,
                .bottom = -k_wall,
                .top = k_ceiling + 0.5,
                .thickness = k_wall},
               windows);
  for (std::size_t i = 0; i < windows.size(); ++i)
    glaze(model, scene.geometry, south, windows[i], windows[i].spring + 1.8 * windows[i].half_width,
          static_cast<int>(i));

  // The roof and its beams, an altar on steps, pews.
  model.paint({0.3f, 0.22f, 0.15f});
  model.box({-k_side - 0.5, k_ceiling, k_east - 0.5}, {k_side + 0.5, k_ceiling + k_wall, k_west + 0.5});
  for (int bay = 0; bay <= k_bays; ++bay) {
    const double z = k_east + bay * k_bay;
    model.box({-k_side - 0.1, k_ceiling - 0.45, z - 0.15}, {k_side + 0.1, k_ceiling + 0.1, z + 0.15});
  }
  model.paint({0.58f, 0.55f, 0.5f});
  model.box({-2.4, -0.1, k_east - 0.1}, {2.4, 0.16, k_east + 3.0});
  model.box({-1.9, -0.1, k_east - 0.1}, {1.9, 0.32, k_east + 2.4});
  model.box({-1.1, 0.3, k_east + 0.9}, {1.1, 1.35, k_east + 1.7});
  model.paint({0.3f, 0.2f, 0.13f});
  for (double z = k_east + 4.4; z < k_west - 3.0; z += 1.3) {
    pew(model, -3.3, z, 2.3);
    pew(model, 1.0, z, 2.3);
  }

  scene.cameras.push_back({"west", {-3.3, 2.3, 3.2}, {1.3, 2.5, -6.0}, {0.0, 1.0, 0.0}, 62.0});
  scene.lights.push_back(
      sun("sun", direction_of_angles({112.0, 30.0}), glm::vec3(1.0f, 0.95f, 0.86f) * 30.0f));
  scene.medium.sigma_s = glm::vec3(0.05f);
  scene.medium.phase = PhaseFunction::henyey_greenstein;
  scene.medium.g = 0.3f;
  scene.surroundings.ambient = glm::vec3(0.05f, 0.055f, 0.07f);
  scene.exposure = 1.0f;
  scene.tone_map = ToneMap::agx;
  return scene;
}

}  // namespace airlight::scene
