#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

#include "scene/light_texture.h"
#include "scene/scene.h"
#include "unit/reference/fixtures.h"

/// Every kind of light and fog that there is, for methods that take them all.
namespace airlight::tests {

/// A kind of light and fog.
struct KindOfLight {
  const char* name;
  glm::dvec3 position{0.3, 0.2, -0.4};
  glm::dvec3 sun{0.0};              ///< towards it
  std::optional<double> top = {};   ///< of the fog
  double inner = 0.0, outer = 0.0;  ///< of a cone, half-angles [rad]
  double range = 0.0;               ///< [m]
  bool is_textured = false;
  float g = 0.0f, sigma = 1.0f;
};
inline void PrintTo(const KindOfLight& kind, std::ostream* stream) {
  *stream << kind.name;
}

inline constexpr KindOfLight k_kinds_of_light[] = {
    {.name = "Lamp"},
    {.name = "FarLamp", .position = {40, 60, -80}},
    {.name = "LampBehind", .position = {0.5, 1.5, 9}},
    {.name = "Spot", .inner = 0.3, .outer = 1.0},
    {.name = "StepOfASpot", .inner = 0.7, .outer = 0.7},
    {.name = "Range", .range = 3.5},
    {.name = "SpotAndRange", .inner = 0.6, .outer = 1.2, .range = 5},
    {.name = "Texture", .is_textured = true},
    {.name = "LayerAround", .top = 3.0},
    {.name = "LayerUnderTheEye", .top = 0.7},
    {.name = "LayerUnderTheLamp", .top = -0.1},
    {.name = "Sun", .sun = {0.5, 0.6, -1}},
    {.name = "SunFromBehind", .sun = {0.3, 0.2, 1}},
    {.name = "SunOnALayer", .sun = {0.5, 0.6, -1}, .top = 1.5},
    {.name = "SunOnALayerUnderTheEye", .sun = {0.5, 0.9, -1}, .top = 0.2},
    {.name = "NarrowLobe", .g = 0.95f},
    {.name = "HeavyFog", .sigma = 12.0f},
};

/// A view of the slats of reference::tests::clutter.
inline scene::View clutter_view(const KindOfLight& kind, int size) {
  scene::View view = reference::tests::clutter_view(size);
  scene::Light& light = view.lights[0];
  const float distance = static_cast<float>(glm::length(kind.position));
  light = glm::length(kind.sun) > 0
              ? scene::sun("", kind.sun, {2, 3, 5})
              : scene::point_light("", kind.position, glm::vec3(2, 3, 5) * (1 + distance * distance));
  if (kind.outer > 0)
    light.cone = {.axis = glm::normalize(glm::dvec3(0.1, -0.3, 1)), .inner = kind.inner, .outer = kind.outer};
  if (kind.range > 0) light.range = kind.range;
  if (kind.is_textured) {
    std::vector<glm::vec3> texels;
    for (int i = 0; i < 16 * 8; ++i)
      texels.emplace_back(1.0f + 0.9f * std::sin(0.7f * static_cast<float>(i)));
    light.texture = std::make_shared<scene::LightTexture>("waves", glm::ivec2(16, 8), texels);
  }
  view.medium.sigma_s = kind.sigma * glm::vec3(0.05f, 0.1f, 0.08f);
  view.medium.sigma_a = kind.sigma * glm::vec3(0.0f, 0.05f, 0.02f);
  view.medium.top = kind.top;
  if (kind.g != 0) view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = kind.g;
  return view;
}

}  // namespace airlight::tests
