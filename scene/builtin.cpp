#include "scene/builtin.h"

#include <array>

#include <fmt/format.h>

#include "scene/builtin_internal.h"

namespace airlight::scene {

namespace {

Scene make_cornell() {
  Scene scene;
  scene.name = "cornell";
  Modeller model(scene.geometry);
  // 2 m inside, open to the front. Walls are solid and overlap, so no light leaks out at the seams.
  constexpr double k_wall = 0.1, k_out = 1.0 + k_wall;
  model.paint({0.73f, 0.73f, 0.73f});
  model.box({-k_out, -k_wall, -k_out}, {k_out, 0.0, 1.0});            // floor
  model.box({-k_out, 2.0, -k_out}, {k_out, 2.0 + k_wall, 1.0});       // ceiling
  model.box({-k_out, -k_wall, -k_out}, {k_out, 2.0 + k_wall, -1.0});  // back
  model.box({-0.67, -0.05, -0.64}, {-0.05, 1.2, -0.02}, 17.0);        // tall block
  model.box({0.03, -0.05, 0.1}, {0.63, 0.6, 0.7}, -17.0);             // short block
  model.paint({0.63f, 0.065f, 0.05f});
  model.box({-k_out, -k_wall, -k_out}, {-1.0, 2.0 + k_wall, 1.0});  // left
  model.paint({0.14f, 0.45f, 0.09f});
  model.box({1.0, -k_wall, -k_out}, {k_out, 2.0 + k_wall, 1.0});  // right

  scene.cameras.push_back({"front", {0.0, 1.0, 4.2}, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}, 38.0});
  scene.lights.push_back(point_light("ceiling", {0.0, 1.85, 0.0}, {1.0f, 0.86f, 0.68f}));
  scene.medium.sigma_s = glm::vec3(0.25f);
  scene.exposure = 5.0f;
  return scene;
}

Scene make_empty() {
  Scene scene;
  scene.name = "empty";
  scene.cameras.push_back({"front", {0.0, 0.0, 5.0}, {0.4, 0.3, 0.0}, {0.0, 1.0, 0.0}, 45.0});
  scene.lights.push_back(point_light("lamp", {0.0, 0.0, 0.0}, glm::vec3(10.0f)));
  scene.medium.sigma_s = glm::vec3(0.1f);
  scene.exposure = 1.0f;
  return scene;
}

Scene make_half_space() {
  // The occluder is the half-plane y = 0, x < 0 (as far as 2000 m is), the light stands above its edge: in
  // shadow is x < 0, y < 0 and nothing else. A view ray eye + t w that leaves the quarter x > 0 below the
  // occluder is lit for t < -eye.x / w.x and dark for ever after; every other one is lit up to where it meets
  // the occluder.
  Scene scene;
  scene.name = "half-space";
  Modeller model(scene.geometry);
  model.paint(glm::vec3(0.5f));
  const std::uint32_t a = model.vertex({0.0, 0.0, 1000.0}), b = model.vertex({0.0, 0.0, -1000.0});
  const std::uint32_t c = model.vertex({-2000.0, 0.0, -1000.0}), d = model.vertex({-2000.0, 0.0, 1000.0});
  model.quad(a, b, c, d);

  scene.cameras.push_back({"below", {1.5, -1.0, 7.0}, {-0.6, -0.2, 0.0}, {0.0, 1.0, 0.0}, 50.0});
  scene.lights.push_back(point_light("lamp", {0.0, 2.0, 0.0}, glm::vec3(10.0f)));
  scene.medium.sigma_s = glm::vec3(0.1f);
  scene.exposure = 3.0f;
  return scene;
}

Scene make_sphere() {
  Scene scene;
  scene.name = "sphere";
  Modeller model(scene.geometry);
  model.paint(glm::vec3(0.6f));

  model.sphere(glm::dvec3(0.0), 1.0, 32);

  scene.cameras.push_back({"side", {1.0, -0.4, 9.0}, {0.8, -0.5, 0.0}, {0.0, 1.0, 0.0}, 45.0});
  scene.lights.push_back(point_light("lamp", {-2.2, 1.5, 0.4}, glm::vec3(10.0f)));
  scene.medium.sigma_s = glm::vec3(0.1f);
  scene.exposure = 4.0f;
  return scene;
}

template <Scene (*make)()>
Scene make_fixed(std::size_t) {
  return make();
}

constexpr auto k_scenes = std::to_array<BuiltinScene>({
    {"window",
     "light falls through gothic tracery into a dark hall, in shafts over pews and floor",
     {},
     make_fixed<make_window>},
    {"nave",
     "a low sun shines through the tall side windows of a church, in shafts that slant across its nave",
     {},
     make_fixed<make_nave>},
    {"fence",
     "a lamp behind a wrought-iron gate: thin bars, scrolls and spears, and their shafts",
     {},
     make_fixed<make_fence>},
    {"forest",
     "a low sun shines through the leaves of a wood towards the beholder, in shafts among trunks and ferns",
     {},
     make_fixed<make_forest>},
    {"jali",
     "a low sun falls through screens of pierced marble, cut out of triangles by a texture, in hundreds of "
     "shafts",
     {},
     make_fixed<make_jali>},
    {"chapel",
     "the sun falls through stained glass, in coloured shafts and onto floor and pews in the glass's colours",
     {},
     make_fixed<make_chapel>},
    {"lighthouse",
     "by night two beams turn above a ship before their tower, and her rigging cuts them into shafts",
     {},
     make_fixed<make_lighthouse>},
    {"harbour",
     "six lamps among masts and cranes in a layer of fog, seen from above it at dusk",
     {},
     make_fixed<make_harbour>},
    {"spheres", "a lamp amid a hundred spheres, whose shadows are cones",
     TriangleCount{
         138'000, 2'000,
         "down to what a hundred icosahedra can have, whose faces are cut into n², or on some of them into "
         "(n + 1)² triangles"},
     make_spheres},
    {"toroid", "a lamp in a ring of seven twisted saddles, which wraps about it and hides it",
     TriangleCount{50'000, 1'000, "to a multiple of 84: each of its 21 patches is a grid"},

     make_toroid},
    {"cornell",
     "a 2 m Cornell box filled with fog, a lamp under its ceiling and two blocks",
     {},
     make_fixed<make_cornell>},
    {"empty", "fog and a lamp, nothing else: airlight has a closed form", {}, make_fixed<make_empty>},
    {"half-space",
     "a half-plane under a lamp: everything below it on one side is dark, in closed form",
     {},
     make_fixed<make_half_space>},
    {"sphere",
     "a unit sphere of 20,480 triangles and the cone of its shadow in fog",
     {},
     make_fixed<make_sphere>},
});

}  // namespace

std::span<const BuiltinScene> builtin_scenes() {
  return k_scenes;
}

const BuiltinScene* find_builtin(std::string_view name) {
  for (const BuiltinScene& scene : k_scenes)
    if (scene.name == name) return &scene;
  return nullptr;
}

std::string count_problem(const BuiltinScene* scene, std::string_view name, std::size_t triangles) {
  if (!scene || !scene->count) {
    std::string names;
    for (const BuiltinScene& other : k_scenes)
      if (other.count) names += fmt::format("{}{}", names.empty() ? "" : ", ", other.name);
    return fmt::format("the triangles of {} are given; only a built-in scene's can be set ({})", name, names);
  }
  if (triangles < scene->count->fewest || triangles > k_most_triangles)
    return fmt::format("{} is not between {} and {}", triangles, scene->count->fewest, k_most_triangles);
  return {};
}

}  // namespace airlight::scene
