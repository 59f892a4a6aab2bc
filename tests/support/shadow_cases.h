#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "frame/none.h"
#include "support/gpu_context.h"
#include "support/random.h"
#include "support/scenes.h"
#include "surface_shadows/brute.h"

/// Scenes, lights and views on which exact methods of surface shadows have to agree, bit for bit.
namespace airlight::tests {

/// What a method answers, row 0 at the top.
inline std::vector<float> visibility(const scene::Geometry& geometry, const scene::View& view,
                                     frame::SurfaceShadow& method) {
  frame::Frame frame(gpu_context(), geometry, 16);
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(nullptr);
  frame.render(view, method, no_airlight, timer);
  return frame.read().visibility.at(0);
}

/// By asking every triangle.
inline std::vector<float> by_brute(const scene::Geometry& geometry, const scene::View& view,
                                   surface_shadows::Culling cull = surface_shadows::Culling::none) {
  surface_shadows::Brute brute({.cull = cull});
  return visibility(geometry, view, brute);
}

inline std::size_t count_lit(const std::vector<float>& visibility) {
  return static_cast<std::size_t>(std::count(visibility.begin(), visibility.end(), 1.0f));
}

/// Triangles of all sizes in a box around the origin, some of them twice, on a floor.
inline scene::Geometry soup(int count) {
  Random random(5);
  scene::Geometry geometry;
  add_quad(geometry, {-6, -2, -6}, {12, 0, 0}, {0, 0, 12});
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 corner = {random.uniform(-2, 2), random.uniform(-2, 1.5), random.uniform(-2, 2)};
    const double size = random.logarithmic(0.01, 1.5);
    const glm::vec3 a(corner), b(corner + size * random.direction()), c(corner + size * random.direction());
    add_triangle(geometry, a, b, c);
    if (i % 10 == 0) add_triangle(geometry, c, b, a);
  }
  return geometry;
}

struct ShadowCase {
  std::string name;
  scene::Geometry geometry;
  scene::View view;
};

inline scene::View view_of_soup(const scene::Light& light) {
  scene::View view;
  view.camera.eye = {3.5, 2.5, 5};
  view.camera.target = {0, -0.5, 0};
  view.lights = {light};
  view.medium.sigma_s = glm::vec3(1e-9f);
  view.size = {64, 48};
  return view;
}

inline const std::vector<ShadowCase>& shadow_cases() {
  static const std::vector<ShadowCase> all = [] {
    std::vector<ShadowCase> cases;
    for (const char* name : {"cornell", "sphere"})
      cases.push_back({name, builtin(name).geometry, view_of(builtin(name), {64, 48})});
    const scene::Geometry triangles = soup(1500);
    const auto lamp = [](glm::dvec3 position) { return scene::point_light("", position, glm::vec3(1e12f)); };
    // Layers, each within the beams of those below it, and under each what only it hides.
    scene::Geometry layers;
    for (int i = 0; i < 12; ++i) {
      const float y = -2.0f + 0.3f * static_cast<float>(i), half = 2.0f - 0.15f * static_cast<float>(i);
      add_triangle(layers, {1 - half, y, 1 - half}, {1 + half, y, 1 - half}, {1, y, 1 + half});
      for (const float x : {0.8f, 1.0f, 1.2f})
        add_triangle(layers, {x, y - 0.1f, 0.9f}, {x + 0.1f, y - 0.1f, 0.9f}, {x, y - 0.1f, 1});
    }
    cases.push_back({"layers", layers, view_of_soup(lamp({1, 4, 1}))});
    cases.push_back({"soup above", triangles, view_of_soup(lamp({1, 4, 1}))});
    cases.push_back({"soup inside", triangles, view_of_soup(lamp({0.1, -0.3, 0.2}))});
    cases.push_back({"soup grazing", triangles, view_of_soup(lamp({5, -1.99, 1}))});
    cases.push_back({"soup far", triangles, view_of_soup(lamp({300, 500, 100}))});
    cases.push_back({"soup sun", triangles, view_of_soup(scene::sun("", {0.3, 1, 0.2}, glm::vec3(1.0f)))});
    cases.push_back(
        {"soup low sun", triangles, view_of_soup(scene::sun("", {1, 0.01, 0.3}, glm::vec3(1.0f)))});
    return cases;
  }();
  return all;
}

/// The same triangles in another order, each from another corner on.
inline scene::Geometry rewritten(scene::Geometry geometry) {
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    glm::uvec3& t = geometry.triangles[i];
    t = i % 3 == 0 ? t : i % 3 == 1 ? glm::uvec3(t.y, t.z, t.x) : glm::uvec3(t.z, t.x, t.y);
  }
  const auto shuffle = [](auto& of_triangles) {
    std::shuffle(of_triangles.begin(), of_triangles.end(), std::mt19937(7));
  };
  shuffle(geometry.triangles);
  shuffle(geometry.material_of_triangle);
  return geometry;
}

/// All of it larger or smaller, in fog as much thinner or thicker.
inline ShadowCase scaled(ShadowCase given, float scale) {
  for (glm::vec3& position : given.geometry.positions) position *= scale;
  given.view.camera.eye *= static_cast<double>(scale);
  given.view.camera.target *= static_cast<double>(scale);
  given.view.lights[0].position *= static_cast<double>(scale);
  given.view.lights[0].intensity *= scale * scale;  // else it would not reach the view
  given.view.medium.sigma_s /= scale;
  return given;
}

/// A closed mesh around the light: an icosahedron whose faces are cut in four, twice, so that most edges and
/// vertices are inside of a face. Its corners are on no axis.
inline scene::Geometry ball() {
  const float g = 1.618034f;
  std::vector<glm::vec3> corners = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<glm::uvec3> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (glm::vec3& corner : corners) corner = glm::normalize(corner);
  for (int cut = 0; cut < 2; ++cut) {
    std::vector<glm::uvec3> cut_faces;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const glm::vec3 at = glm::normalize(corners[std::min(a, b)] + corners[std::max(a, b)]);
      const auto found = std::find(corners.begin(), corners.end(), at);
      if (found != corners.end()) return static_cast<std::uint32_t>(found - corners.begin());
      corners.push_back(at);
      return static_cast<std::uint32_t>(corners.size() - 1);
    };
    for (const glm::uvec3& f : faces) {
      const std::uint32_t ab = middle(f.x, f.y), bc = middle(f.y, f.z), ca = middle(f.z, f.x);
      cut_faces.insert(cut_faces.end(), {{f.x, ab, ca}, {ab, f.y, bc}, {ca, bc, f.z}, {ab, bc, ca}});
    }
    faces = cut_faces;
  }
  scene::Geometry geometry;
  geometry.materials.emplace_back();
  geometry.positions = corners;
  geometry.triangles = faces;
  geometry.material_of_triangle.assign(faces.size(), 0);
  return geometry;
}

/// A floor, above it a box and beside that an open sheet that faces up.
inline scene::Geometry box_and_sheet() {
  scene::Geometry geometry;
  add_quad(geometry, {-6, -2, -6}, {0, 0, 12}, {12, 0, 0});
  add_box(geometry, {-1.5f, -1, -1}, {0, 0, 1});
  add_quad(geometry, {0.5f, -1, -1}, {0, 0, 2}, {1.5f, 0, 0});
  return geometry;
}

}  // namespace airlight::tests
