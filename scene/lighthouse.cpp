#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "scene/shore.h"
#include "scene/view_fields.h"

// A lighthouse on its rock, by night and in fog: two opposite beams turn above a ship that lies before it,
// and her rigging cuts them into shafts. A moon behind it all makes silhouettes of what the beams do not
// reach.
//
// Every part is a closed solid.

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr glm::dvec3 k_foot{11.0, 4.6, -22.0};  // of the tower [m]
constexpr double k_gallery = 15.0;              // above the foot [m]
constexpr double k_focus = 16.9;                // the lamp, above the foot [m]

void add_tower(Modeller& model) {
  // White with two red bands.
  constexpr std::array<double, 6> k_bands = {-0.6, 3.2, 6.2, 9.2, 12.2, 14.2};
  const auto radius = [](double y) { return 2.15 - 0.062 * y + 0.5 * std::exp(-1.2 * std::max(y, 0.0)); };
  for (std::size_t i = 0; i + 1 < k_bands.size(); ++i) {
    model.paint(i % 2 == 1 ? glm::vec3(0.45f, 0.06f, 0.045f) : glm::vec3(0.72f, 0.7f, 0.66f));
    std::array<glm::dvec2, 6> profile;
    for (std::size_t k = 0; k < profile.size(); ++k) {
      const double y = std::lerp(k_bands[i], k_bands[i + 1], static_cast<double>(k) / (profile.size() - 1.0));
      profile[k] = {radius(y), y};
    }
    model.turned(k_foot, profile, 40);
  }
  const double top = radius(k_bands.back());
  model.paint({0.55f, 0.53f, 0.5f});
  model.turned(k_foot,
               std::array<glm::dvec2, 5>{
                   {{top, 14.1}, {top + 0.15, 14.4}, {2.2, 14.8}, {2.3, 14.82}, {2.3, k_gallery}}},
               40);
  // Railing of the gallery.
  model.paint({0.1f, 0.1f, 0.1f});
  for (double y : {0.45, 0.8, 1.15}) hoop(model, k_foot + glm::dvec3(0.0, k_gallery + y, 0.0), 2.2, 0.05, 40);
  for (int i = 0; i < 20; ++i) {
    const double angle = 2.0 * k_pi * i / 20.0;
    const glm::dvec3 post =
        k_foot + glm::dvec3(2.2 * std::cos(angle), k_gallery - 0.05, 2.2 * std::sin(angle));
    pole(model, post, post + glm::dvec3(0.0, 1.2, 0.0), 0.03);
  }
  // The lantern: a wall, slanting bars between hoops, and a roof.
  model.paint({0.5f, 0.48f, 0.45f});
  model.turned(k_foot, std::array<glm::dvec2, 3>{{{1.35, k_gallery - 0.1}, {1.35, 15.9}, {1.25, 16.0}}}, 40);
  model.paint({0.08f, 0.08f, 0.08f});
  constexpr int k_bars = 14;
  const auto at = [](int i, double y) {
    const double angle = 2.0 * k_pi * (i + 0.5) / k_bars;
    return k_foot + glm::dvec3(1.25 * std::cos(angle), y, 1.25 * std::sin(angle));
  };
  for (double y : {16.0, 16.9, 17.9}) hoop(model, k_foot + glm::dvec3(0.0, y, 0.0), 1.25, 0.05, 42);
  for (int i = 0; i < k_bars; ++i) {
    pole(model, at(i, 15.95), at(i + 1, 17.95), 0.022);
    pole(model, at(i + 1, 15.95), at(i, 17.95), 0.022);
  }
  model.paint({0.3f, 0.07f, 0.05f});
  model.turned(k_foot,
               std::array<glm::dvec2, 8>{{{1.5, 17.9},
                                          {1.5, 18.0},
                                          {1.3, 18.35},
                                          {0.95, 18.75},
                                          {0.5, 19.05},
                                          {0.22, 19.15},
                                          {0.22, 19.5},
                                          {0.05, 19.6}}},
               32);
  pole(model, k_foot + glm::dvec3(0.0, 19.5, 0.0), k_foot + glm::dvec3(0.0, 21.2, 0.0), 0.03);
}

/// The keeper's house: walls, a gabled roof, a chimney.
void add_house(Modeller& model) {
  const glm::dvec3 at = k_foot + glm::dvec3(-5.4, -0.5, 2.2);
  model.paint({0.6f, 0.57f, 0.52f});
  model.box(at + glm::dvec3(-2.4, -0.6, -1.7), at + glm::dvec3(2.4, 2.5, 1.7));
  model.box(at + glm::dvec3(1.2, 2.5, -0.4), at + glm::dvec3(1.8, 5.0, 0.4));
  model.paint({0.2f, 0.1f, 0.08f});
  // The roof: a prism whose ridge runs along X.
  std::array<std::uint32_t, 6> v;
  for (std::size_t i = 0; i < 2; ++i) {
    const double x = i == 0 ? -2.7 : 2.7;
    v[3 * i] = model.vertex(at + glm::dvec3(x, 2.4, 2.1));
    v[3 * i + 1] = model.vertex(at + glm::dvec3(x, 2.4, -2.1));
    v[3 * i + 2] = model.vertex(at + glm::dvec3(x, 4.3, 0.0));
  }
  model.triangle(v[0], v[2], v[1]);
  model.triangle(v[3], v[4], v[5]);
  model.quad(v[0], v[3], v[5], v[2]);
  model.quad(v[4], v[1], v[2], v[5]);
  model.quad(v[0], v[1], v[4], v[3]);
}

}  // namespace

Scene make_lighthouse() {
  Scene scene;
  scene.name = "lighthouse";
  Modeller model(scene.geometry);
  Random random(5);
  model.paint({0.16f, 0.2f, 0.24f});
  sea(model, 400.0, 0.7);

  // The headland, and what has fallen off it.
  model.paint({0.16f, 0.145f, 0.13f});
  rock(model, random, {11.5, -2.0, -23.0}, {13.0, 6.9, 9.5});
  rock(model, random, {3.0, -2.0, -20.0}, {7.5, 5.0, 6.0});
  rock(model, random, {21.0, -2.0, -20.0}, {9.0, 6.0, 8.0});
  for (int i = 0; i < 46; ++i) {
    const double part = random.between(0.0, 1.0), angle = k_pi * random.between(-0.15, 1.1);
    const double size = 0.5 + 2.6 * std::pow(random.between(0.0, 1.0), 2.0);
    rock(model, random,
         {9.0 + (13.0 + 6.0 * part) * std::cos(angle), -0.8, -21.0 + (9.0 + 6.0 * part) * std::sin(angle)},
         {size * random.between(0.8, 1.4), 0.8 + size * random.between(0.5, 1.0), size});
  }
  // Those at the beholder's feet.
  for (const glm::dvec3& at :
       {glm::dvec3(6.5, -1.0, 6.0), {9.0, -1.0, 3.0}, {4.2, -1.0, 8.2}, {-8.5, -1.0, 7.0}, {11.5, -1.0, 6.5}})
    rock(model, random, at, {random.between(1.5, 2.8), random.between(1.8, 2.8), random.between(1.2, 2.2)});

  add_tower(model);
  add_house(model);
  ship(model, {.at = {-6.0, 0.0, -14.2},
               .heading = 206.0,
               .length = 19.0,
               .mast_height = 21.0,
               .masts = 2,
               .yards = 4});

  scene.cameras.push_back({"rocks", {-3.0, 2.4, 12.0}, {-0.4, 9.8, -20.0}, {0.0, 1.0, 0.0}, 58.0});
  const glm::dvec3 lamp = k_foot + glm::dvec3(0.0, k_focus, 0.0);
  // Towards the ship and a little down, and away from it.
  for (double hand : {1.0, -1.0}) {
    Light beam =
        point_light(hand > 0.0 ? "beam" : "back-beam", lamp, glm::vec3(1.0f, 0.88f, 0.66f) * 50000.0f);
    beam.cone = {.axis = glm::normalize(glm::dvec3(-0.92 * hand, -0.09, 0.38 * hand)),
                 .inner = glm::radians(3.0),
                 .outer = glm::radians(10.0)};
    scene.lights.push_back(beam);
  }
  scene.lights.push_back(
      sun("moon", direction_of_angles({202.0, 17.0}), glm::vec3(0.4f, 0.55f, 1.0f) * 0.75f));
  scene.lights.push_back(
      point_light("door", k_foot + glm::dvec3(-2.6, 2.2, 3.6), glm::vec3(1.0f, 0.6f, 0.25f) * 22.0f));
  scene.lights.push_back(point_light("anchor", {-13.4, 5.2, -10.2}, glm::vec3(1.0f, 0.7f, 0.35f) * 32.0f));
  scene.medium.sigma_s = glm::vec3(0.012f);
  scene.medium.phase = PhaseFunction::henyey_greenstein;
  scene.medium.g = 0.5f;
  scene.exposure = 1.4f;
  return scene;
}

}  // namespace airlight::scene
