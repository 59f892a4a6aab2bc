#include "frame/blocks.h"

#include <algorithm>

namespace airlight::frame {

float near_depth(const SceneBuffers& scene, glm::dvec3 apex, double eye_light_distance) {
  // The nearest point may lie in the corner of a cube face, where depth is 1/√3 of distance.
  const double nearest = 0.5 * scene.distance_to(apex);
  return static_cast<float>(
      std::clamp(nearest, 0.5 * SceneBuffers::k_touch * eye_light_distance, eye_light_distance));
}

shaders::CameraBlock camera_block(const scene::CameraFrame& camera, glm::ivec2 image_size, float near) {
  const glm::vec3 eye_high(camera.eye);
  shaders::CameraBlock block{};
  block.eye_high = eye_high;
  block.eye_low = glm::vec3(camera.eye - glm::dvec3(eye_high));
  block.half_width = static_cast<float>(camera.half_width);
  block.half_height = static_cast<float>(camera.half_height);
  block.right = glm::vec3(camera.right);
  block.up = glm::vec3(camera.up);
  block.forward = glm::vec3(camera.forward);
  block.image_width = static_cast<float>(image_size.x);
  block.image_height = static_cast<float>(image_size.y);
  block.near = near;
  return block;
}

shaders::LightBlock light_block(const scene::Light& light, glm::dvec3 eye, float near, int shadow_map_size) {
  shaders::LightBlock block{};
  block.from_eye = glm::vec3(light.position - eye);
  block.near = near;
  block.intensity = light.intensity;
  block.shadow_map_size = static_cast<float>(shadow_map_size);
  return block;
}

shaders::MediumBlock medium_block(const scene::Medium& medium) {
  shaders::MediumBlock block{};
  block.sigma_s = medium.sigma_s;
  block.g = medium.g;
  block.sigma_t = medium.sigma_s + medium.sigma_a;
  block.rayleigh_weight = medium.rayleigh_weight;
  return block;
}

}  // namespace airlight::frame
