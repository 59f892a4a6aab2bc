#include "frame/blocks.h"

#include <algorithm>
#include <cmath>

namespace airlight::frame {

float near_depth(const SceneBuffers& scene, glm::dvec3 apex, double eye_light_distance, double half_width,
                 double half_height) {
  // The nearest point may lie in the pyramid's corner, where depth is least; and something for rounding.
  const double share = 0.85 / std::sqrt(1.0 + half_width * half_width + half_height * half_height);
  const double nearest = std::max(scene.distance_to(apex), SceneBuffers::k_touch * eye_light_distance);
  return static_cast<float>(share * (std::isfinite(nearest) ? nearest : eye_light_distance));
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

shaders::LightBlock light_block(const scene::Light& light, glm::dvec3 eye, float near, int shadow_map_size,
                                const std::optional<ShadowPlane>& plane) {
  shaders::LightBlock block{};
  const bool is_sun = scene::is_sun(light);
  block.from_eye = glm::vec3(is_sun ? light.towards : light.position - eye);
  block.is_near = is_sun ? 0.0f : 1.0f;
  block.intensity = is_sun ? light.irradiance : light.intensity;
  block.shadow_map_size = static_cast<float>(shadow_map_size);
  block.near = near;
  block.axis = glm::vec3(scene::direction_to(light, eye));
  block.inverse_distance = is_sun ? 0.0f : static_cast<float>(1.0 / glm::distance(light.position, eye));
  block.cone_outer = shaders::k_no_cone;
  if (light.cone) {
    // 1 − cos x = 2 sin²(x / 2)
    const auto fall = [](double x) { return 2.0 * std::sin(0.5 * x) * std::sin(0.5 * x); };
    const double outer = fall(light.cone->outer), inner = fall(light.cone->inner);
    block.cone_axis = glm::vec3(light.cone->axis);
    block.cone_outer = static_cast<float>(outer);
    block.cone_ramp = outer > inner ? static_cast<float>(1.0 / (outer - inner)) : 0.0f;
  }
  block.inverse_range = light.range ? static_cast<float>(1.0 / *light.range) : 0.0f;
  if (plane) {
    block.depth_scale = static_cast<float>(plane->depth_scale);
    block.depth_offset = static_cast<float>(plane->depth_offset);
    block.half_texel = static_cast<float>(plane->half_texel);
    block.image_x = glm::vec4(plane->image_x);
    block.image_y = glm::vec4(plane->image_y);
  } else {
    block.half_texel = static_cast<float>(glm::distance(light.position, eye) / shadow_map_size);
  }
  return block;
}

shaders::MediumBlock medium_block(const scene::Medium& medium, glm::dvec3 eye) {
  shaders::MediumBlock block{};
  block.sigma_s = medium.sigma_s;
  block.g = medium.g;
  block.sigma_t = medium.sigma_s + medium.sigma_a;
  block.rayleigh_weight = medium.rayleigh_weight;
  block.top = medium.top ? static_cast<float>(*medium.top - eye.y) : shaders::k_no_top;
  return block;
}

}  // namespace airlight::frame
