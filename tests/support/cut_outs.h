#pragma once

#include <array>

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "support/scenes.h"

/// A wall over a floor, of which a texture cuts away the right half, and the same walls made by geometry.
namespace airlight::tests {

/// @param left, right of the wall [m]; it has two triangles, and the floor the last two
inline scene::Geometry wall_over_floor(float left, float right) {
  scene::Geometry geometry;
  add_quad(geometry, {left, -1, -5}, {right - left, 0, 0}, {0, 2, 0});
  add_quad(geometry, {-8, -1, 2}, {16, 0, 0}, {0, 0, -14});
  return geometry;
}

inline scene::Geometry whole_wall() {
  return wall_over_floor(-1, 1);
}
inline scene::Geometry half_wall() {
  return wall_over_floor(-1, 0);
}

/// The whole wall, whose texture's alpha falls below a half in its middle.
inline scene::Geometry half_cut_away() {
  scene::Geometry geometry = whole_wall();
  geometry.textures = {{{2, 1}, {{255, 255, 255, 255}, {255, 255, 255, 0}}}};
  geometry.texture_places.assign(geometry.triangles.size(), {});
  geometry.texture_places[0] = {{{0, 1}, {1, 1}, {1, 0}}};
  geometry.texture_places[1] = {{{0, 1}, {1, 0}, {0, 0}}};
  geometry.materials.push_back({.albedo = geometry.materials[0].albedo,
                                .texture = 0,
                                .wrap = {scene::TextureWrap::clamp, scene::TextureWrap::clamp},
                                .cut_out = scene::CutOut{0, 0.5f}});
  geometry.material_of_triangle[0] = geometry.material_of_triangle[1] = 1;
  return geometry;
}

/// The lamp behind the wall, before it the eye.
inline scene::View view_of_half_wall(glm::ivec2 size) {
  scene::View view;
  view.camera.eye = {0.1, 0.3, 1};
  view.camera.target = {0, -0.1, -5};
  view.camera.vertical_fov_degrees = 40;
  view.lights[0].position = {-0.3, 0.4, -7};
  view.lights[0].intensity = glm::vec3(20);
  view.medium.sigma_s = glm::vec3(0.1f);
  view.size = size;
  return view;
}

}  // namespace airlight::tests
