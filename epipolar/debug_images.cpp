#include "epipolar/debug_images.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "epipolar/space_math.h"
#include "frame/screen_pass.h"

#include "spirv/epipolar/shadowed_samples_frag.h"

namespace airlight::epipolar {
namespace {

constexpr int k_longest_side = 4096;  ///< of a picture of the grid [pixels]

int divide_up(int a, int b) {
  return (a + b - 1) / b;
}

/// Counts the bits on the CPU, which reads a grid of any size at once.
frame::DebugImage grid_image(const std::vector<std::uint32_t>& bits, const Resolution& resolution,
                             const char* name, const char* caption) {
  const auto& [alpha, theta, phi] = resolution;
  const int columns = divide_up(alpha, k_longest_side), rows = divide_up(theta, k_longest_side);
  frame::DebugImage image{name, caption, {divide_up(alpha, columns), divide_up(theta, rows)}, {}};
  const auto pixel_of = [&](int i, int j) {
    return static_cast<std::size_t>(j / rows) * static_cast<std::size_t>(image.size.x) +
           static_cast<std::size_t>(i / columns);
  };
  const auto pixels = static_cast<std::size_t>(image.size.x) * static_cast<std::size_t>(image.size.y);
  std::vector<std::int64_t> set(pixels), all(pixels);
  auto word = bits.begin();
  for (int j = 0; j < theta; ++j) {
    for (int i = 0; i < alpha; ++i) {
      const std::size_t pixel = pixel_of(i, j);
      all[pixel] += phi;
      for (const auto end = word + phi / 32; word != end; ++word) set[pixel] += std::popcount(*word);
    }
  }
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    image.values.push_back(
        static_cast<float>(static_cast<double>(set[pixel]) / static_cast<double>(all[pixel])));
  return image;
}

/// What a tree is made over.
frame::DebugImage first_occluders(const Grid& grid) {
  const auto& [alpha, theta, phi] = grid.resolution();
  const int columns = divide_up(phi, k_longest_side), rows = divide_up(theta, k_longest_side);
  frame::DebugImage image{
      "first_occluders",
      "where shadow begins on each light ray, in the range of α: a row for each θ, φ to the right",
      {divide_up(phi, columns), divide_up(theta, rows)},
      {}};
  const std::vector<std::uint32_t> first = grid.first_shadowed().read<std::uint32_t>();
  for (int j = 0; j < theta; j += rows)
    for (int k = 0; k < phi; k += columns)
      image.values.push_back(
          static_cast<float>(first[static_cast<std::size_t>(j) * static_cast<std::size_t>(phi) +
                                   static_cast<std::size_t>(k)]) /
          static_cast<float>(alpha));
  return image;
}

frame::DebugImage shadowed_samples(const ShadowVolume& volume, const frame::FrameInputs& inputs) {
  const frame::ScreenPass pass(k_shadowed_samples_frag, volume.reader_constants());
  const gpu::Texture fractions(gpu::Format::r32f, inputs.view.size);
  inputs.surfaces.bind_sampler(shaders::k_surface_unit);
  pass.run({fractions});
  return {"shadowed_samples", "shadowed samples of each view ray before it ends, of all its samples",
          inputs.view.size, fractions.read<float>()};
}

}  // namespace

frame::DebugImage debug_slice(const ShadowVolume& volume, glm::vec3 direction) {
  const Grid& grid = volume.grid();
  const auto& [alpha, theta, phi] = grid.resolution();
  const shaders::EpipolarBlock& space = volume.block();
  const auto rows = static_cast<std::uint32_t>(std::min(alpha, k_longest_side / 8));
  const std::uint32_t plane =
      shaders::theta_cell(space, shaders::theta_of(space, direction), static_cast<std::uint32_t>(theta));
  const shaders::Angle of_ray = shaders::alpha_of(shaders::eye_angle(space, direction, 0.0f));
  const std::uint32_t row = shaders::alpha_cell(space, of_ray, static_cast<std::uint32_t>(alpha));
  const std::vector<std::uint32_t> first =
      grid.first_shadowed().read<std::uint32_t>(std::int64_t{plane} * phi, phi);
  frame::DebugImage image{"slice",
                          fmt::format("half-plane {} of {}, row {} of {}: shadow is dark, φ to the right",
                                      plane, theta, row, alpha),
                          {phi, static_cast<int>(rows)},
                          {}};
  const std::uint32_t cells = static_cast<std::uint32_t>(alpha) / rows;
  for (std::uint32_t i = 0; i < rows; ++i)
    for (const std::uint32_t start : first) {
      const bool is_own = i == std::min(row / cells, rows - 1);
      image.values.push_back(is_own               ? (start <= i * cells ? 0.35f : 0.65f)
                             : start <= i * cells ? 0.0f
                                                  : 1.0f);
    }
  return image;
}

std::vector<frame::DebugImage> debug_images(ShadowVolume& volume, const frame::FrameInputs& inputs) {
  const Grid& grid = volume.grid();
  if (grid.bits().bytes() == 0) return {first_occluders(grid)};
  frame::DebugImage after =
      grid_image(volume.bits(), grid.resolution(), "grid_after_scan",
                 "voxels in shadow on each view ray of the grid: a row for each θ, α to the right");
  frame::DebugImage samples = shadowed_samples(volume, inputs);
  volume.fill_unscanned(inputs);
  frame::DebugImage before = grid_image(
      grid.bits().read<std::uint32_t>(), grid.resolution(), "grid_before_scan",
      "voxels where shadow begins, on each view ray of the grid: a row for each θ, α to the right");
  return {std::move(before), std::move(after), std::move(samples)};
}

}  // namespace airlight::epipolar
