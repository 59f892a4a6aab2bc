#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "support/random.h"

namespace airlight::tests {

/// One within 10 m of the origin that looks anywhere.
inline scene::CameraFrame random_camera(Random& random) {
  const glm::dvec3 forward = random.direction();
  const glm::dvec3 right = glm::normalize(glm::cross(forward, random.direction()));
  return {.eye = random.in_box(10),
          .right = right,
          .up = glm::cross(right, forward),
          .forward = forward,
          .half_width = random.logarithmic(0.02, 3),
          .half_height = random.logarithmic(0.02, 3)};
}

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
