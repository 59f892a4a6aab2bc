#include "scene/fitted_ambient.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/scenes.h"

namespace airlight::scene {
namespace {

/// A cube of 2 m, of area 24 m².
Geometry cube() {
  Geometry geometry;
  tests::add_box(geometry, {-1, -1, -1}, {1, 1, 1});
  geometry.materials[0].albedo = {0.5f, 0.25f, 0.0f};
  return geometry;
}

void expect_near(glm::vec3 a, glm::dvec3 b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(a[i]), b[i], 1e-6 * (b[i] + 1e-9));
}

TEST(FittedAmbient, SpreadsALampsLightOverTheBox) {
  // 0.5/π · 4π · 6 / 24
  expect_near(fitted_ambient(cube(), std::array{point_light("", {}, glm::vec3(6))}, {}), {0.5, 0.25, 0});
}

TEST(FittedAmbient, OfASpotTakesItsConeAndOfASunWhatFallsOnTheBox) {
  Light spot = point_light("", {}, glm::vec3(6));
  spot.cone = {.inner = 0.1, .outer = std::numbers::pi / 3};  // a quarter of the sphere
  expect_near(fitted_ambient(cube(), std::array{spot}, {}), {0.125, 0.0625, 0});
  // From above onto 4 m²: 0.5/π · 6 · 4 / 24
  expect_near(fitted_ambient(cube(), std::array{sun("", {0, 1, 0}, glm::vec3(6))}, {}),
              glm::dvec3(0.5, 0.25, 0) / std::numbers::pi);
}

TEST(FittedAmbient, AbsorptionTakesItsPartAndScatteringNone) {
  const Medium medium{.sigma_s = glm::vec3(5), .sigma_a = {0.0f, 1.0f, 0.0f}};
  expect_near(fitted_ambient(cube(), std::array{point_light("", {}, glm::vec3(6))}, medium),
              {0.5, 0.25 * std::exp(-std::sqrt(3.0)), 0});
}

TEST(FittedAmbient, WeighsColoursByAreaAndTexels) {
  Geometry geometry = cube();
  geometry.textures = {{{2, 1}, {{255, 255, 255, 255}, {0, 0, 0, 255}}}};
  geometry.materials.push_back({.albedo = glm::vec3(1), .texture = 0});
  // A quarter of the cube's twelve triangles.
  for (std::size_t i = 0; i < 3; ++i) geometry.material_of_triangle[i] = 1;
  expect_near(fitted_ambient(geometry, std::array{point_light("", {}, glm::vec3(6))}, {}),
              {0.75 * 0.5 + 0.25 * 0.5, 0.75 * 0.25 + 0.25 * 0.5, 0.25 * 0.5});
}

TEST(FittedAmbient, IsNoneWithoutSurfaces) {
  EXPECT_EQ(fitted_ambient({}, std::array{point_light("", {}, glm::vec3(6))}, {}), glm::vec3(0));
}

}  // namespace
}  // namespace airlight::scene
