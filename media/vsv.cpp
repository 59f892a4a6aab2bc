#include "media/vsv.h"

#include <array>
#include <numbers>

#include <fmt/format.h>

#include "epipolar/debug_images.h"
#include "media/medium.h"
#include "scene/error.h"

#include "spirv/media/phi_growth_comp.h"
#include "spirv/media/vsv_riemann_comp.h"
#include "spirv/media/vsv_table_build_comp.h"
#include "spirv/media/vsv_table_comp.h"

namespace airlight::media {
namespace {

/// Rows of the table in α. S is smooth in α: linear interpolation between 256 rows over at most π errs by
/// 2e-5 of S.
constexpr std::uint32_t k_table_rows = 256;

/// How many cells a ray must cross for the table to serve it: 0, any will do, unless the view comes so near
/// to α = π, where φ_d ≤ π − α, that its rays may end within four of the widest cells.
std::uint32_t direct_cells(const shaders::EpipolarBlock& space, const epipolar::Resolution& resolution) {
  constexpr std::uint32_t k_cells = 4;
  constexpr float k_widest = 1.8f;  // of φ_max / N_φ, at the largest growth (shaders/media/phi_growth.comp)
  const float alpha_max = space.alpha_min + space.alpha_step * static_cast<float>(resolution.alpha);
  const float reach = k_cells * k_widest * std::numbers::pi_v<float> / static_cast<float>(resolution.phi);
  return std::numbers::pi_v<float> - alpha_max < reach ? k_cells : 0;
}

}  // namespace

Vsv::Vsv(const gpu::Context& context, const epipolar::VolumeSettings& volume, VsvIntegral integral,
         PhiCells phi_cells)
    : volume_(context.limits(), volume),
      integral_(integral),
      phi_cells_(phi_cells),
      medium_block_(sizeof(shaders::MediumBlock)) {}

void Vsv::load(const gpu::Context& context, const Variant& variant) {
  if (loaded_ == variant) return;
  const epipolar::Resolution& resolution = volume_.grid().resolution();
  const auto grid = epipolar::resolution_constants(resolution);
  const std::array<gpu::Constant, 8> constants = {grid[0],
                                                  grid[1],
                                                  grid[2],
                                                  gpu::Constant(3, variant.phase),
                                                  gpu::Constant(4, variant.channels),
                                                  gpu::Constant(5, k_table_rows),
                                                  gpu::Constant(6, variant.direct),
                                                  gpu::Constant(7, integral_ == VsvIntegral::factored)};
  phi_growth_ = gpu::Pipeline::compute(k_phi_growth_comp, std::array{grid[0], constants[3]});
  if (integral_ != VsvIntegral::riemann) {
    build_table_ = gpu::Pipeline::compute(k_vsv_table_build_comp, std::span(constants).first<6>());
    integrate_ = gpu::Pipeline::compute(k_vsv_table_comp, constants);
    table_ = gpu::Buffer(std::int64_t{k_table_rows} * (resolution.phi + 1) * variant.channels * 8);
    table_texels_ = {context.limits(), table_, gpu::Format::rg32f, "the table integral"};
  } else {
    integrate_ = gpu::Pipeline::compute(
        k_vsv_riemann_comp,
        std::array{grid[0], grid[1], grid[2], constants[3], gpu::Constant(4, variant.light_textured)});
  }
  loaded_ = variant;
}

void Vsv::require_support(VsvIntegral integral, const scene::PointLight& light) {
  if (!light.texture || integral == VsvIntegral::riemann) return;
  throw scene::Error(scene::ExitCode::usage,
                     fmt::format("vsv:integral={}", integral == VsvIntegral::table ? "table" : "factored"),
                     "it cannot take a light texture", "use vsv:integral=riemann");
}

void Vsv::integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) {
  require_support(integral_, inputs.view.light);
  shaders::MediumBlock block = medium_block(inputs.view);
  const bool is_grey = block.sigma_t.x == block.sigma_t.y && block.sigma_t.y == block.sigma_t.z;
  const epipolar::Resolution& resolution = volume_.grid().resolution();
  const shaders::EpipolarBlock space = volume_.find_ranges(inputs);
  load(inputs.context, {static_cast<std::uint32_t>(inputs.view.medium.phase), is_grey ? 1u : 3u,
                        direct_cells(space, resolution), inputs.light_texture != nullptr});
  inputs.timer.time("ranges", [&] {
    block.table_row_step =
        space.alpha_step * static_cast<float>(resolution.alpha) / static_cast<float>(k_table_rows - 1);
    medium_block_.write(&block, sizeof block);
    medium_block_.bind_uniform(2);
    if (phi_cells_ == PhiCells::growing) phi_growth_.dispatch({1, 1, 1});
  });
  volume_.fill(inputs);
  if (integral_ != VsvIntegral::riemann) {
    inputs.timer.time("table", [&] {
      table_.bind_storage(6);
      build_table_.dispatch({k_table_rows, 1, 1});
    });
  }
  inputs.timer.time("integrate", [&] {
    inputs.surfaces.bind_sampler(0);
    if (integral_ != VsvIntegral::riemann) table_texels_.bind_sampler(13);
    if (inputs.light_texture) inputs.light_texture->bind_sampler(14);
    radiance.bind_image(0);
    integrate_.dispatch({inputs.view.size, 1});
  });
}

std::map<std::string, std::int64_t> Vsv::bytes() const {
  std::map<std::string, std::int64_t> bytes = volume_.bytes();
  if (integral_ != VsvIntegral::riemann) bytes["table"] = table_.bytes();
  return bytes;
}

std::vector<frame::DebugImage> Vsv::debug_images(const frame::FrameInputs& inputs) {
  return epipolar::debug_images(volume_, inputs);
}

}  // namespace airlight::media
