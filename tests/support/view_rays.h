#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::tests {

/// The unit view ray through a point of the image, in [−1, 1]², y upwards.
inline glm::dvec3 view_ray(const scene::CameraFrame& camera, double x, double y) {
  return glm::normalize(camera.forward + x * camera.half_width * camera.right +
                        y * camera.half_height * camera.up);
}

/// The unit view ray through a pixel's centre; row 0 is at the top.
inline glm::dvec3 pixel_ray(const scene::CameraFrame& camera, glm::ivec2 size, int x, int y) {
  return view_ray(camera, 2 * (x + 0.5) / size.x - 1, 1 - 2 * (y + 0.5) / size.y);
}

/// The same of the pixel at that place in an image's rows.
inline glm::dvec3 pixel_ray(const scene::CameraFrame& camera, glm::ivec2 size, std::size_t pixel) {
  const int at = static_cast<int>(pixel);
  return pixel_ray(camera, size, at % size.x, at / size.x);
}

}  // namespace airlight::tests
