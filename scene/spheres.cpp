#include <array>
#include <cmath>
#include <vector>

#include "scene/builtin_internal.h"

// A hundred spheres about a lamp. Each is closed and stands free of the others.

namespace airlight::scene {
namespace {

constexpr std::size_t k_spheres = 100;
constexpr double k_nearest = 0.9, k_farthest = 3.4;  // spheres from the lamp [m]

struct Sphere {
  glm::dvec3 centre;
  double radius;
};

/// Throws spheres at the shell around the lamp until a hundred have found a free place.
std::vector<Sphere> scatter() {
  Random random(7);
  std::vector<Sphere> spheres;
  while (spheres.size() < k_spheres) {
    const double z = random.between(-1.0, 1.0), y = random.between(-1.0, 1.0);
    const glm::dvec3 at(random.between(-1.0, 1.0), y, z);
    const double radius = 0.12 + 0.3 * std::pow(random.between(0.0, 1.0), 2.0);
    const glm::dvec3 centre = k_farthest * at;
    const double distance = glm::length(centre);
    bool is_free = distance - radius > k_nearest && distance + radius < k_farthest;
    for (const Sphere& other : spheres)
      is_free = is_free && glm::distance(centre, other.centre) > radius + other.radius + 0.05;
    if (is_free) spheres.push_back({centre, radius});
  }
  return spheres;
}

}  // namespace

Scene make_spheres(std::size_t triangles) {
  Scene scene;
  scene.name = "spheres";
  Modeller model(scene.geometry);

  const std::vector<Sphere> spheres = scatter();
  std::uint32_t cuts = 1;
  while (20 * k_spheres * (cuts + 1) * (cuts + 1) <= triangles) ++cuts;
  // What is left over makes some spheres finer.
  const std::size_t finer = (triangles - 20 * k_spheres * cuts * cuts) / (20 * (2 * cuts + 1));
  constexpr std::array<glm::vec3, 5> k_colours = {{{0.75f, 0.72f, 0.68f},
                                                   {0.7f, 0.28f, 0.16f},
                                                   {0.2f, 0.42f, 0.55f},
                                                   {0.8f, 0.6f, 0.25f},
                                                   {0.3f, 0.5f, 0.3f}}};
  for (std::size_t i = 0; i < k_spheres; ++i) {
    model.paint(k_colours[i % k_colours.size()]);
    model.sphere(spheres[i].centre, spheres[i].radius, i < finer ? cuts + 1 : cuts);
  }

  scene.cameras.push_back({"side", {1.5, 1.0, 7.2}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 52.0});
  scene.lights.push_back(point_light("lamp", {0.0, 0.0, 0.0}, glm::vec3(1.0f, 0.8f, 0.55f) * 40.0f));
  scene.medium.sigma_s = glm::vec3(0.12f);
  scene.exposure = 1.5f;
  return scene;
}

}  // namespace airlight::scene
