#include "epipolar/grid.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "epipolar/space_math.h"
#include "scene/error.h"

namespace airlight::epipolar {

using scene::Error;
using scene::ExitCode;

namespace {

constexpr const char* k_remedy = "ask for fewer cells with --alpha, --theta, --phi";

std::int64_t plane_bytes(const Resolution& resolution) {
  return std::int64_t{resolution.alpha} * resolution.phi / 8;
}

/// Cuts the planes into windows that start where a binding may start. A plane takes one group in y at most,
/// and its mip chain (MipScan) has an entry for each α and up to one more for each level.
std::vector<Window> cut(const Resolution& resolution, const gpu::Limits& limits) {
  const std::int64_t bytes = plane_bytes(resolution);
  const int levels = std::bit_width(static_cast<unsigned>(resolution.alpha));
  const std::int64_t room = bytes + std::int64_t{levels} * resolution.phi / 8;
  std::int64_t planes = std::min<std::int64_t>(
      {limits.max_storage_block_bytes / room, limits.max_work_groups.y, resolution.theta});
  while (planes > 0 && planes < resolution.theta && planes * bytes % limits.storage_offset_alignment != 0)
    --planes;
  if (planes == 0) gpu::require_storage_block(limits, room * resolution.theta, "the grid", k_remedy);
  std::vector<Window> windows;
  for (int first = 0; first < resolution.theta; first += static_cast<int>(planes))
    windows.push_back({first, std::min(static_cast<int>(planes), resolution.theta - first)});
  return windows;
}

}  // namespace

void validate(const Resolution& resolution) {
  const auto require = [](bool good, const char* option, int value, const char* rule) {
    if (!good) throw Error(ExitCode::usage, option, fmt::format("{} is not {}", value, rule));
  };
  require(resolution.alpha >= 1 && resolution.alpha <= k_largest_count, "--alpha", resolution.alpha,
          "between 1 and 131072");
  require(resolution.theta >= 1 && resolution.theta <= k_largest_count, "--theta", resolution.theta,
          "between 1 and 131072");
  require(resolution.phi >= 128 && resolution.phi % 128 == 0 && resolution.phi <= k_largest_count, "--phi",
          resolution.phi, "a multiple of 128 between 128 and 131072");
}

std::array<gpu::Constant, 3> resolution_constants(const Resolution& resolution) {
  return {gpu::Constant(0, static_cast<std::uint32_t>(resolution.alpha)),
          gpu::Constant(1, static_cast<std::uint32_t>(resolution.theta)),
          gpu::Constant(2, static_cast<std::uint32_t>(resolution.phi))};
}

Grid::Grid(const gpu::Limits& limits, const Resolution& resolution, bool has_bits) : resolution_(resolution) {
  validate(resolution);
  const auto& [alpha, theta, phi] = resolution;
  const std::string name = fmt::format("the {} × {} × {} grid", alpha, theta, phi);
  if (has_bits) {
    gpu::require_texels(limits, std::int64_t{alpha} * theta * phi / 128, name, k_remedy);
    windows_ = cut(resolution, limits);
    bits_ = gpu::Buffer(plane_bytes(resolution) * theta);
    texels_ = {limits, bits_, gpu::Format::rgba32ui, name};
  }
  const std::int64_t light_rays = std::int64_t{theta} * phi;
  gpu::require_storage_block(limits, 4 * light_rays, "the light rays of " + name, k_remedy);
  first_shadowed_ = gpu::Buffer(4 * light_rays);
  first_shadowed_texels_ = {limits, first_shadowed_, gpu::Format::rgba32ui, name};
  block_ = gpu::Buffer(sizeof(shaders::EpipolarBlock));
  constexpr auto k_float = static_cast<std::int64_t>(sizeof(float));
  phi_range_ = gpu::Buffer((2 + std::int64_t{theta}) * k_float);
  planes_ = gpu::Buffer(std::int64_t{theta} * 8 * k_float);
  plane_texels_ = {limits, planes_, gpu::Format::rgba32f, name};
  box_ranges_ = gpu::Buffer(std::int64_t{theta} * 2 * k_float);
  box_range_texels_ = {limits, box_ranges_, gpu::Format::rg32f, name};
}

void Grid::bind() const {
  block_.bind_uniform(shaders::k_space_block);
  phi_range_.bind_storage(shaders::k_phi_range_storage);
  first_shadowed_.bind_storage(shaders::k_first_shadowed_storage);
  plane_texels_.bind_sampler(shaders::k_planes_unit);
  (bits_.bytes() > 0 ? texels_ : first_shadowed_texels_).bind_sampler(shaders::k_grid_unit);
  first_shadowed_texels_.bind_sampler(shaders::k_first_shadowed_unit);
}

void Grid::bind_box_ranges() const {
  box_range_texels_.bind_sampler(shaders::k_scratch_unit);
}

void Grid::bind_window(const Window& window) const {
  const std::int64_t bytes = plane_bytes(resolution_);
  bits_.bind_storage(shaders::k_grid_storage, window.first_plane * bytes, window.planes * bytes);
}

void set_window(const gpu::Pipeline& program, const Window& window) {
  program.set(0, glm::uvec2(window.first_plane, window.planes));
}

void dispatch_planes(const gpu::Pipeline& program, const Grid& grid, int invocations_x) {
  for (const Window& window : grid.windows()) {
    grid.bind_window(window);
    set_window(program, window);
    program.dispatch({invocations_x, window.planes, 1});
  }
}

}  // namespace airlight::epipolar
