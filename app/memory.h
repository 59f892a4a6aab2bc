#pragma once

#include <cstddef>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::app {

/// What there is to hold, roughly.
struct Holding {
  glm::ivec2 size{0};               ///< of the image; 0 for none
  std::size_t bytes_per_pixel = 0;  ///< on a driver that runs on the CPU, which has its images in this memory
  int shadow_map = 0;               ///< side of a face of the shadow map [texels]; 0 for none
  std::size_t triangles = 0;
  std::size_t looks = 0;  ///< bytes of the model's textures and normals
  int scenes = 1;         ///< how often all of that is there
};

/// What a model's textures and normals take, here and by the driver.
std::size_t bytes_of_looks(const scene::Geometry& geometry);

/// A frame's images, and one copy of each in turn as it is read; 85 measured at 8192².
constexpr std::size_t k_bytes_of_render = 90;

/// A frame's images, which stay for the next frame, and a copy of all.
constexpr std::size_t k_bytes_of_path = 120;

/// The same and the truth, a run's images, and what its errors are found in.
constexpr std::size_t k_bytes_of_compare = 225;

/// What each light beside the first adds to them: its airlight and visibility, a copy of each, and its truth.
constexpr std::size_t k_bytes_of_rendered_light = 40, k_bytes_of_compared_light = 105;

/// The truth of each of a path's frames, by one light.
constexpr std::size_t k_bytes_of_path_frame = 20;

/// Out of memory a driver aborts, or says that it is not there: what cannot fit is refused before it is
/// woken.
/// @throws scene::Error (driver) naming the size, what it takes and what is left: of the address space that
/// `ulimit -v` allows, or of the machine's memory
void require_memory(const Holding& holding);

}  // namespace airlight::app
