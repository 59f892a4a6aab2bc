#include "epipolar/grid.h"

#include <fmt/format.h>

#include "epipolar/space_math.h"
#include "scene/error.h"

namespace airlight::epipolar {

using scene::Error;
using scene::ExitCode;

void validate(const Resolution& resolution) {
  const auto require = [](bool good, const char* option, int value, const char* rule) {
    if (!good) throw Error(ExitCode::usage, option, fmt::format("{} is not {}", value, rule));
  };
  // Indices are counted in single-precision floats on their way to a cell.
  require(resolution.alpha >= 1 && resolution.alpha <= 1 << 20, "--alpha", resolution.alpha,
          "between 1 and 1048576");
  require(resolution.theta >= 1 && resolution.theta <= 1 << 20, "--theta", resolution.theta,
          "between 1 and 1048576");
  require(resolution.phi >= 128 && resolution.phi % 128 == 0 && resolution.phi <= 1 << 20, "--phi",
          resolution.phi, "a multiple of 128 between 128 and 1048576");
}

std::array<gpu::Constant, 3> resolution_constants(const Resolution& resolution) {
  return {gpu::Constant(0, static_cast<std::uint32_t>(resolution.alpha)),
          gpu::Constant(1, static_cast<std::uint32_t>(resolution.theta)),
          gpu::Constant(2, static_cast<std::uint32_t>(resolution.phi))};
}

Grid::Grid(const gpu::Context& context, const Resolution& resolution) : resolution_(resolution) {
  validate(resolution);
  const std::int64_t bytes = std::int64_t{resolution.alpha} * resolution.theta * resolution.phi / 8;
  gpu::require_storage_block(
      context.limits(), bytes,
      fmt::format("the {} × {} × {} grid", resolution.alpha, resolution.theta, resolution.phi),
      "ask for fewer cells with --alpha, --theta, --phi");
  bits_ = gpu::Buffer(bytes);
  texels_ = {context, bits_, gpu::Format::rgba32ui, "the grid"};
  block_ = gpu::Buffer(sizeof(shaders::EpipolarBlock));
  phi_range_ = gpu::Buffer(2 * sizeof(float));
}

void Grid::bind() const {
  block_.bind_uniform(1);
  phi_range_.bind_storage(4);
  bits_.bind_storage(5);
  texels_.bind_sampler(12);
}

}  // namespace airlight::epipolar
