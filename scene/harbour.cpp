#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "scene/shore.h"
#include "scene/view_fields.h"

// A harbour at dusk, seen from above the layer of fog that its lamps glow in: masts, cranes and roofs stand
// out of it, and what stands within throws its shadow through it.
//
// Every part is a closed solid.

namespace airlight::scene {
namespace {

constexpr double k_quay = 1.8;                                              // its height above the water [m]
constexpr double k_edge = -10.0;                                            // where the quay ends [m]
constexpr double k_pier_left = 5.0, k_pier_right = 9.5, k_pier_end = 17.0;  // [m]

constexpr glm::vec3 k_iron{0.07f, 0.07f, 0.075f}, k_wood{0.26f, 0.19f, 0.13f}, k_stone{0.3f, 0.28f, 0.26f};

/// A lamp post whose lamp hangs from an arm.
/// @param towards where the arm points, level, of unit length
/// @returns where its light is
glm::dvec3 add_lamp(Modeller& model, glm::dvec2 foot, glm::dvec2 towards) {
  constexpr double k_height = 4.6, k_arm = 0.9;
  const glm::dvec3 base(foot.x, k_quay - 0.05, foot.y), arm(towards.x, 0.0, towards.y);
  const glm::dvec3 head = base + glm::dvec3(0.0, k_height, 0.0);
  model.paint(k_iron);
  model.turned(base, std::array<glm::dvec2, 4>{{{0.2, 0.0}, {0.2, 0.3}, {0.09, 0.5}, {0.06, k_height + 0.1}}},
               8);
  pole(model, head, head + k_arm * arm, 0.04);
  // The hood, a cone above the light, and the cage about it.
  const glm::dvec3 lamp = head + k_arm * arm;
  model.turned(lamp, std::array<glm::dvec2, 3>{{{0.13, -0.12}, {0.12, -0.08}, {0.05, 0.06}}}, 12);
  const glm::dvec3 light = lamp - glm::dvec3(0.0, 0.34, 0.0);
  for (int i = 0; i < 4; ++i) {
    const double angle = 0.5 * std::numbers::pi * (i + 0.5);
    const glm::dvec3 out(0.2 * std::cos(angle), 0.0, 0.2 * std::sin(angle));
    pole(model, light + out + glm::dvec3(0.0, 0.2, 0.0), light + 0.6 * out - glm::dvec3(0.0, 0.2, 0.0), 0.012,
         4);
  }
  hoop(model, light - glm::dvec3(0.0, 0.2, 0.0), 0.12, 0.025, 10);
  return light;
}

/// A lattice of four legs, braced, between two levels.
void add_lattice(Modeller& model, glm::dvec3 foot, double height, double lower, double upper, int storeys) {
  const auto corner = [&](int k, double part) {
    const double half = std::lerp(lower, upper, part);
    return foot + glm::dvec3(k == 0 || k == 3 ? -half : half, height * part, k < 2 ? -half : half);
  };
  for (int k = 0; k < 4; ++k) {
    pole(model, corner(k, 0.0), corner(k, 1.0), 0.11, 6);
    for (int i = 0; i < storeys; ++i) {
      const double from = static_cast<double>(i) / storeys, to = static_cast<double>(i + 1) / storeys;
      const int next = (k + 1) % 4;
      pole(model, corner(k, from), corner(next, to), 0.05, 4);
      pole(model, corner(next, from), corner(k, to), 0.05, 4);
      pole(model, corner(k, to), corner(next, to), 0.06, 4);
    }
  }
}

/// A crane: a braced tower, a cabin, a jib that reaches over the water, and its load.
/// @param turn of the jib, from +X towards −Z [degrees]
void add_crane(Modeller& model, glm::dvec2 foot, double turn) {
  const glm::dvec3 base(foot.x, k_quay - 0.05, foot.y);
  model.paint({0.2f, 0.15f, 0.05f});
  add_lattice(model, base, 9.5, 1.9, 0.8, 4);
  const glm::dvec3 top = base + glm::dvec3(0.0, 9.5, 0.0);
  const glm::dvec3 out(std::cos(glm::radians(turn)), 0.0, -std::sin(glm::radians(turn))),
      across(out.z, 0.0, -out.x);
  model.box(top + glm::dvec3(-1.2, -0.1, -1.0), top + glm::dvec3(1.2, 1.9, 1.0), turn);
  const glm::dvec3 root = top + 0.9 * out + glm::dvec3(0.0, 0.6, 0.0);
  const glm::dvec3 tip = top + 12.5 * out + glm::dvec3(0.0, 6.0, 0.0);
  const glm::dvec3 mast = top + glm::dvec3(0.0, 5.0, 0.0) - 0.8 * out;
  // The jib: three chords, braced.
  const auto chord = [&](int k, double part) {
    const double narrow = 1.0 - 0.8 * part;
    const glm::dvec3 off = k == 2 ? glm::dvec3(0.0, 0.9, 0.0) : (k == 0 ? 0.5 : -0.5) * across;
    return glm::mix(root, tip, part) + narrow * off;
  };
  constexpr int k_bays = 9;
  for (int k = 0; k < 3; ++k) {
    pole(model, chord(k, 0.0), chord(k, 1.0), 0.07, 5);
    for (int i = 0; i < k_bays; ++i)
      pole(model, chord(k, static_cast<double>(i) / k_bays), chord((k + 1) % 3, (i + 1.0) / k_bays), 0.04, 4);
  }
  for (double hand : {-0.7, 0.7}) pole(model, top + hand * across + glm::dvec3(0.0, 1.8, 0.0), mast, 0.07);
  rope(model, mast, tip, 0.03);
  rope(model, mast, glm::mix(root, tip, 0.6), 0.03);
  rope(model, mast, top - 1.1 * out + glm::dvec3(0.0, 1.8, 0.0), 0.03);
  // The load: bales in a sling.
  const double drop = 10.0;
  const glm::dvec3 hook = tip - glm::dvec3(0.0, drop, 0.0);
  rope(model, tip, hook, 0.03);
  model.paint(k_wood);
  model.box(hook + glm::dvec3(-0.8, -2.0, -0.6), hook + glm::dvec3(0.8, -0.9, 0.6), turn + 20.0);
  for (double x : {-0.7, 0.7})
    for (double z : {-0.5, 0.5}) pole(model, hook, hook + glm::dvec3(x, -1.0, z), 0.02, 4);
}

/// A shed with a gabled roof along X.
void add_shed(Modeller& model, glm::dvec3 lower, glm::dvec3 size) {
  const double eaves = 0.62 * size.y;
  model.paint({0.22f, 0.14f, 0.11f});
  model.box(lower - glm::dvec3(0.0, 0.1, 0.0), lower + glm::dvec3(size.x, eaves, size.z));
  model.paint({0.13f, 0.13f, 0.15f});
  const Plane gable = {lower + glm::dvec3(0.5 * size.x, 0.0, 0.5 * size.z),
                       {0.0, 0.0, -1.0},
                       {0.0, 1.0, 0.0},
                       {1.0, 0.0, 0.0}};
  const double half = 0.5 * size.z + 0.4;
  bar(model, gable, {{-half, eaves - 0.2}, {0.0, size.y}, {half, eaves - 0.2}}, false, 0.35, size.x + 0.8);
  for (double part : {0.25, 0.7}) {
    const double x = lower.x + part * size.x;
    model.box({x, lower.y + size.y - 0.9, lower.z + 0.4 * size.z},
              {x + 0.8, lower.y + size.y + 1.0, lower.z + 0.4 * size.z + 0.8});
  }
}

}  // namespace

Scene make_harbour() {
  Scene scene;
  scene.name = "harbour";
  Modeller model(scene.geometry);
  Random random(11);
  model.paint({0.07f, 0.1f, 0.12f});
  sea(model, 400.0, 0.16);

  // Quay and pier; the pier stands on piles.
  model.paint(k_stone);
  model.box({-80.0, -5.0, -90.0}, {80.0, k_quay, k_edge});
  model.box({-80.0, k_quay - 0.2, k_edge - 0.5}, {80.0, k_quay + 0.18, k_edge + 0.12});
  model.paint(k_wood);
  for (double z = k_edge - 0.2; z < k_pier_end; z += 0.32)
    model.box({k_pier_left, k_quay - 0.18, z},
              {k_pier_right, k_quay + random.between(-0.015, 0.015), z + 0.29});
  for (double x : {k_pier_left + 0.3, k_pier_right - 0.3}) {
    model.box({x - 0.12, k_quay - 0.5, k_edge}, {x + 0.12, k_quay - 0.1, k_pier_end});
    for (double z = k_edge + 2.0; z < k_pier_end; z += 3.0)
      pole(model, {x, -5.0, z}, {x, k_quay + 0.7, z}, 0.17, 8);
  }
  // A railing on the pier's right, of posts and a chain.
  model.paint(k_iron);
  for (double z = k_edge + 0.5; z < k_pier_end - 1.0; z += 1.5) {
    pole(model, {k_pier_right - 0.1, k_quay - 0.1, z}, {k_pier_right - 0.1, k_quay + 1.1, z}, 0.04);
    rope(model, {k_pier_right - 0.1, k_quay + 1.0, z}, {k_pier_right - 0.1, k_quay + 1.0, z + 1.5}, 0.025,
         0.15);
  }

  // Sheds behind, cranes on the edge.
  add_shed(model, {-34.0, k_quay, -31.0}, {18.0, 8.5, 11.0});
  add_shed(model, {-12.0, k_quay, -33.0}, {15.0, 7.5, 10.0});
  add_shed(model, {8.0, k_quay, -32.0}, {22.0, 9.0, 12.0});
  add_crane(model, {-15.0, -13.5}, -64.0);
  add_crane(model, {15.0, -13.5}, -125.0);

  // Boats on both sides of the pier and along the quay.
  ship(model, {.at = {-8.0, 0.0, -6.0},
               .heading = 182.0,
               .length = 19.0,
               .mast_height = 18.0,
               .masts = 2,
               .yards = 2});
  ship(model,
       {.at = {1.6, 0.0, 6.5}, .heading = 91.0, .length = 12.5, .mast_height = 13.0, .masts = 1, .yards = 0});
  ship(model, {.at = {13.2, 0.0, 3.0},
               .heading = 268.0,
               .length = 14.0,
               .mast_height = 14.5,
               .masts = 2,
               .yards = 0});
  ship(model,
       {.at = {-4.6, 0.0, 3.5}, .heading = 75.0, .length = 6.5, .mast_height = 7.5, .masts = 1, .yards = 0});
  ship(model,
       {.at = {-9.5, 0.0, 8.0}, .heading = 40.0, .length = 7.5, .mast_height = 8.6, .masts = 1, .yards = 0});
  ship(
      model,
      {.at = {19.0, 0.0, -3.0}, .heading = 100.0, .length = 7.0, .mast_height = 8.0, .masts = 1, .yards = 0});
  ship(model, {.at = {-25.0, 0.0, -6.5},
               .heading = 175.0,
               .length = 9.0,
               .mast_height = 10.3,
               .masts = 1,
               .yards = 0});

  // Bollards and the lines made fast to them.
  model.paint(k_iron);
  const std::array<glm::dvec2, 4> bollards = {
      {{-16.5, k_edge - 0.6}, {0.2, k_edge - 0.6}, {k_pier_left + 0.4, 1.6}, {k_pier_left + 0.4, 11.4}}};
  for (const glm::dvec2& at : bollards)
    model.turned({at.x, k_quay - 0.05, at.y},
                 std::array<glm::dvec2, 4>{{{0.17, 0.0}, {0.14, 0.4}, {0.24, 0.5}, {0.2, 0.62}}}, 10);
  const auto fast = [&](std::size_t k) { return glm::dvec3(bollards[k].x, k_quay + 0.35, bollards[k].y); };
  model.paint({0.3f, 0.25f, 0.17f});
  rope(model, fast(0), {-16.8, 1.9, -6.2}, 0.04, 0.2);
  rope(model, fast(1), {0.6, 1.7, -6.0}, 0.04, 0.2);
  rope(model, fast(2), {2.0, 1.1, 0.8}, 0.035, 0.15);
  rope(model, fast(3), {1.7, 1.2, 12.2}, 0.035, 0.15);

  // Crates and barrels where they were put down.
  for (const glm::dvec2& pile :
       {glm::dvec2(-6.0, -13.5), {-23.5, -14.0}, {6.2, 13.6}, {21.0, -14.0}, {1.5, -15.5}}) {
    model.paint(k_wood);
    for (int i = 0; i < 7; ++i) {
      const bool is_above = i >= 5;
      const double size = random.between(0.5, 0.95), spread = is_above ? 0.4 : 1.0;
      const double z = pile.y + spread * random.between(-1.0, 1.0);
      const glm::dvec3 at(pile.x + spread * random.between(-1.6, 1.6), k_quay + (is_above ? 0.73 : -0.02), z);
      if (i % 3 == 2)
        model.turned(at, std::array<glm::dvec2, 4>{{{0.28, 0.0}, {0.36, 0.3}, {0.36, 0.65}, {0.28, 0.95}}},
                     12);
      else
        model.box(at - glm::dvec3(0.5 * size, 0.0, 0.5 * size), at + glm::dvec3(0.5 * size, size, 0.5 * size),
                  random.between(0.0, 90.0));
    }
  }

  constexpr glm::vec3 k_warm{1.0f, 0.62f, 0.28f};
  const auto light = [&](const char* name, glm::dvec2 foot, glm::dvec2 towards, double power,
                         glm::vec3 colour) {
    scene.lights.push_back(
        point_light(name, add_lamp(model, foot, towards), colour * static_cast<float>(power)));
  };
  light("quay", {-8.5, k_edge - 1.2}, {0.0, 1.0}, 110.0, k_warm);
  light("pier", {k_pier_left + 0.5, -3.0}, {-1.0, 0.0}, 110.0, k_warm);
  light("pier-end", {k_pier_left + 0.5, 12.5}, {-1.0, 0.0}, 110.0, k_warm);
  light("quay-east", {22.5, k_edge - 1.2}, {0.0, 1.0}, 110.0, k_warm);
  light("yard", {6.0, -24.5}, {0.0, 1.0}, 140.0, {0.5f, 0.85f, 1.0f});
  // A lantern on the nearest boat.
  scene.lights.push_back(point_light("boat", {-8.4, 2.6, 7.2}, k_warm * 45.0f));
  scene.lights.push_back(
      sun("dusk", direction_of_angles({250.0, 14.0}), glm::vec3(0.34f, 0.42f, 0.8f) * 1.6f));

  scene.cameras.push_back({"masthead", {-12.0, 15.0, 20.5}, {0.9, 0.8, -6.0}, {0.0, 1.0, 0.0}, 50.0});
  scene.medium.sigma_s = glm::vec3(0.035f);
  scene.medium.sigma_a = glm::vec3(0.002f);
  scene.medium.top = 7.5;
  scene.exposure = 1.2f;
  return scene;
}

}  // namespace airlight::scene
