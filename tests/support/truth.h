#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/shared.h"

/// Images by Blender Cycles, a renderer that shares nothing with Airlight. They, their views and noise (0.5 %
/// rms a pixel) are described in truth/README.md of the shared data.
namespace airlight::tests {

struct CyclesImage {
  const char* image;
  const char* scene;
  glm::dvec3 eye, target;
  double fov_degrees;
  glm::dvec3 light;  ///< where a point is, towards a sun
  float intensity;   ///< of a sun, its irradiance
  float sigma_s, sigma_a, g;
  float albedo;
  std::optional<double> fog_top = {};
  scene::LightKind kind = scene::LightKind::point;
  std::optional<glm::dvec3> spot_target = {};
  double spot_degrees = 0;  ///< half-angle of the spot's cone, which ends in a step
  std::vector<scene::Light> more_lights = {};

  std::filesystem::path image_file() const { return shared_file("truth/" + std::string(image) + ".exr"); }
  std::filesystem::path scene_file() const { return shared_file("scenes/" + std::string(scene) + ".glb"); }

  scene::View view() const {
    scene::View view;
    view.camera.eye = eye;
    view.camera.target = target;
    view.camera.vertical_fov_degrees = fov_degrees;
    view.lights[0] = kind == scene::LightKind::sun ? scene::sun("", light, glm::vec3(intensity))
                                                   : scene::point_light("", light, glm::vec3(intensity));
    view.lights.insert(view.lights.end(), more_lights.begin(), more_lights.end());
    if (spot_target)
      view.lights[0].cone = {.axis = glm::normalize(*spot_target - light),
                             .inner = glm::radians(spot_degrees),
                             .outer = glm::radians(spot_degrees)};
    view.medium.sigma_s = glm::vec3(sigma_s);
    view.medium.sigma_a = glm::vec3(sigma_a);
    if (g != 0) view.medium.phase = scene::PhaseFunction::henyey_greenstein;
    view.medium.g = g;
    view.medium.top = fog_top;
    view.size = {256, 256};
    return view;
  }
};

inline void PrintTo(const CyclesImage& truth, std::ostream* stream) {
  *stream << truth.image;
}

// clang-format off
inline const CyclesImage k_cycles_airlight[] = {
    {"cornell_airlight", "cornell_box_36", {0, 1, 3.6}, {0, 1, 0}, 40, {0.2, 1.85, 0.1}, 2, 0.3f, 0.05f, 0, 0},
    {"fence_airlight", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {-0.2, 0.7, -1.0}, 8, 0.25f, 0, 0, 0},
    {"maple_airlight", "maple_198k", {-2, 2, 11}, {0.5, 3.8, 0}, 50, {1.5, 5, -5}, 200, 0.06f, 0, 0.5f, 0},
    {"sponza_airlight", "sponza_262k", {-12, 3, -0.5}, {0, 5, 0}, 60, {3, 7, 0}, 300, 0.04f, 0.01f, 0, 0},
};
inline const CyclesImage k_cycles_full =
    {"fence_full", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {1.5, 1.2, 1.8}, 8, 0.25f, 0, 0, 0.5f};
inline const CyclesImage k_cycles_sun_airlight[] = {
    {"maple_sun_airlight", "maple_198k", {-2, 2, 11}, {0.5, 3.8, 0}, 50, {0.35, 0.45, -1}, 10, 0.06f, 0, 0.5f, 0, 12, scene::LightKind::sun},
    {"sponza_sun_airlight", "sponza_262k", {-12, 3, -0.5}, {0, 5, 0}, 60, {0.35, 1, 0.15}, 10, 0.04f, 0.01f, 0, 0, 16, scene::LightKind::sun},
};
inline const CyclesImage k_cycles_spot_airlight =
    {"fence_spot_airlight", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {-0.2, 0.7, -1.0}, 8, 0.25f, 0, 0, 0, {}, scene::LightKind::point, glm::dvec3(0.4, 0.4, 1), 30};
inline const CyclesImage k_cycles_sun_full =
    {"fence_sun_full", "victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, 45, {-0.5, 0.6, 1}, 10, 0.25f, 0, 0, 0.5f, 4, scene::LightKind::sun};
inline const CyclesImage k_cycles_three_full =
    {"cornell_three_full", "cornell_box_36", {0, 1, 3.6}, {0, 1, 0}, 40, {0.2, 1.85, 0.1}, 2, 0.3f, 0.05f, 0, 0.5f, {}, scene::LightKind::point, {}, 0,
     {scene::point_light("", {-0.7, 0.5, 0.8}, glm::vec3(0.7f)), scene::point_light("", {0.6, 1.2, -0.6}, glm::vec3(1.2f))}};
// clang-format on

inline std::vector<CyclesImage> all_cycles_images() {
  std::vector<CyclesImage> images(std::begin(k_cycles_airlight), std::end(k_cycles_airlight));
  images.push_back(k_cycles_full);
  images.insert(images.end(), std::begin(k_cycles_sun_airlight), std::end(k_cycles_sun_airlight));
  images.push_back(k_cycles_sun_full);
  images.push_back(k_cycles_spot_airlight);
  images.push_back(k_cycles_three_full);
  return images;
}

inline double mean(const std::vector<float>& values) {
  double sum = 0;
  for (float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

inline double percentile(std::vector<float> values, double percent) {
  std::sort(values.begin(), values.end());
  return static_cast<double>(
      values[static_cast<std::size_t>(percent / 100 * static_cast<double>(values.size() - 1))]);
}

}  // namespace airlight::tests
