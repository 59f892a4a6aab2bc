#include "scene/builtin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "scene/builtin_internal.h"

namespace airlight::scene {

void Modeller::box(glm::dvec3 lower, glm::dvec3 upper, double turn_degrees) {
  const glm::dvec3 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  const double c = std::cos(glm::radians(turn_degrees)), s = std::sin(glm::radians(turn_degrees));
  std::array<std::uint32_t, 8> v;
  for (std::size_t i = 0; i < 8; ++i) {
    const double x = i & 1 ? half.x : -half.x, y = i & 2 ? half.y : -half.y, z = i & 4 ? half.z : -half.z;
    v[i] = vertex(middle + glm::dvec3(c * x + s * z, y, c * z - s * x));
  }
  quad(v[0], v[4], v[6], v[2]);
  quad(v[1], v[3], v[7], v[5]);
  quad(v[0], v[1], v[5], v[4]);
  quad(v[2], v[6], v[7], v[3]);
  quad(v[0], v[2], v[3], v[1]);
  quad(v[4], v[5], v[7], v[6]);
}

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
  scene.lights.push_back({"ceiling", {0.0, 1.85, 0.0}, {1.0f, 0.86f, 0.68f}});
  scene.medium.sigma_s = glm::vec3(0.25f);
  scene.exposure = 5.0f;
  return scene;
}

Scene make_empty() {
  Scene scene;
  scene.name = "empty";
  scene.cameras.push_back({"front", {0.0, 0.0, 5.0}, {0.4, 0.3, 0.0}, {0.0, 1.0, 0.0}, 45.0});
  scene.lights.push_back({"lamp", {0.0, 0.0, 0.0}, glm::vec3(10.0f)});
  scene.medium.sigma_s = glm::vec3(0.1f);
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
  scene.lights.push_back({"lamp", {0.0, 2.0, 0.0}, glm::vec3(10.0f)});
  scene.medium.sigma_s = glm::vec3(0.1f);
  scene.exposure = 3.0f;
  return scene;
}

Scene make_sphere() {
  Scene scene;
  scene.name = "sphere";
  Modeller model(scene.geometry);
  model.paint(glm::vec3(0.6f));

  // An icosahedron, each triangle cut into four until there are 20 · 4⁵ = 20,480.
  const double g = std::numbers::phi;
  const std::array<glm::dvec3, 12> corners = {{{-1, g, 0},
                                               {1, g, 0},
                                               {-1, -g, 0},
                                               {1, -g, 0},
                                               {0, -1, g},
                                               {0, 1, g},
                                               {0, -1, -g},
                                               {0, 1, -g},
                                               {g, 0, -1},
                                               {g, 0, 1},
                                               {-g, 0, -1},
                                               {-g, 0, 1}}};
  std::vector<glm::dvec3> points;
  for (glm::dvec3 corner : corners) points.push_back(glm::normalize(corner));
  std::vector<glm::uvec3> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < 5; ++level) {
    std::map<std::pair<glm::uint, glm::uint>, glm::uint> middle_of_edge;
    const auto middle = [&](glm::uint i, glm::uint j) {
      const auto [at, is_new] =
          middle_of_edge.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<glm::uint>(points.size()));
      if (is_new) points.push_back(glm::normalize(points[i] + points[j]));
      return at->second;
    };
    std::vector<glm::uvec3> finer;
    for (glm::uvec3 f : faces) {
      const glm::uint ab = middle(f.x, f.y), bc = middle(f.y, f.z), ca = middle(f.z, f.x);
      finer.insert(finer.end(), {{f.x, ab, ca}, {f.y, bc, ab}, {f.z, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  for (glm::dvec3 point : points) model.vertex(point);
  for (glm::uvec3 f : faces) model.triangle(f.x, f.y, f.z);

  scene.cameras.push_back({"side", {1.0, -0.4, 9.0}, {0.8, -0.5, 0.0}, {0.0, 1.0, 0.0}, 45.0});
  scene.lights.push_back({"lamp", {-2.2, 1.5, 0.4}, glm::vec3(10.0f)});
  scene.medium.sigma_s = glm::vec3(0.1f);
  scene.exposure = 4.0f;
  return scene;
}

constexpr auto k_scenes = std::to_array<BuiltinScene>({
    {"window", "light falls through gothic tracery into a dark hall, in shafts over pews and floor",
     make_window},
    {"cornell", "a 2 m Cornell box filled with fog, a lamp under its ceiling and two blocks", make_cornell},
    {"empty", "fog and a lamp, nothing else: airlight has a closed form", make_empty},
    {"half-space", "a half-plane under a lamp: everything below it on one side is dark, in closed form",
     make_half_space},
    {"sphere", "a unit sphere of 20,480 triangles and the cone of its shadow in fog", make_sphere},
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

}  // namespace airlight::scene
