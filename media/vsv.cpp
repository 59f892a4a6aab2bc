#include "media/vsv.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "epipolar/debug_images.h"
#include "media/medium.h"

#include "spirv/media/phi_growth_comp.h"
#include "spirv/media/vsv_riemann_frag.h"
#include "spirv/media/vsv_table_build_comp.h"
#include "spirv/media/vsv_table_frag.h"

namespace airlight::media {
namespace {

/// Rows of the table in α. With lobes of |g| ≤ 0.8, 128 rows err by up to 0.03 % of an image of empty fog
/// (rrmse, as all of these); 512 rows by 0.3 % with |g| = 0.99, by 0.8 % with |g| = k_narrowest_lobe.
std::uint32_t table_rows(bool rough) {
  return rough ? 512 : 128;
}
constexpr float k_narrowest_lobe = 0.995f;

/// Whether the integrand changes much within a cell of φ: a lobe of the phase function is narrow, or light
/// reaches not farther than a few cells of φ.
bool is_rough(const scene::Medium& medium, float distance) {
  constexpr float k_wide_lobe = 0.8f, k_deep = 8.0f;
  const glm::vec3 depth = (medium.sigma_s + medium.sigma_a) * distance;
  return std::abs(medium.g) > k_wide_lobe || std::max({depth.x, depth.y, depth.z}) > k_deep;
}

/// How many cells a ray must cross for the table to serve it: 0, any will do, unless the view comes so near
/// to α = π, where φ_d ≤ π − α, that its rays may end within four of the widest cells.
std::uint32_t direct_cells(const shaders::EpipolarBlock& space, const epipolar::Resolution& resolution) {
  constexpr std::uint32_t k_cells = 4;
  constexpr float k_widest = 1.8f;  // of φ_max / N_φ, at the largest growth (shaders/media/phi_growth.comp)
  const shaders::Angle alpha_max = space.alpha_min + space.alpha_step * static_cast<float>(resolution.alpha);
  const shaders::Angle reach = k_cells * k_widest * shaders::k_half_turn / static_cast<float>(resolution.phi);
  return shaders::k_half_turn - alpha_max < reach ? k_cells : 0;
}

}  // namespace

Vsv::Vsv(const gpu::Context& context, const VsvOptions& options)
    : options_(options), volume_(context.limits(), options.volume) {}

void Vsv::load(const gpu::Context& context, const Variant& variant) {
  if (loaded_ == variant) return;
  const epipolar::Resolution& resolution = volume_.grid().resolution();
  const auto grid = epipolar::resolution_constants(resolution);
  const std::array<gpu::Constant, 10> constants = {
      grid[0],
      grid[1],
      grid[2],
      gpu::Constant(3, variant.phase),
      gpu::Constant(4, variant.channels),
      gpu::Constant(5, table_rows(variant.rough)),
      gpu::Constant(6, variant.direct),
      gpu::Constant(7, options_.integral == VsvIntegral::factored),
      gpu::Constant(8, options_.volume.populate == epipolar::Populate::conservative),
      gpu::Constant(9, variant.rough)};
  phi_growth_ = gpu::Pipeline::compute(k_phi_growth_comp, std::array{grid[0], constants[3]});
  if (options_.integral != VsvIntegral::riemann) {
    build_table_ = gpu::Pipeline::compute(k_vsv_table_build_comp, constants);
    integrate_ = frame::ScreenPass(k_vsv_table_frag, constants);
    table_ =
        gpu::Buffer(std::int64_t{table_rows(variant.rough)} * (resolution.phi + 1) * variant.channels * 8);
    table_texels_ = {context.limits(), table_, gpu::Format::rg32f, "the table integral"};
  } else {
    integrate_ = frame::ScreenPass(
        k_vsv_riemann_frag, std::array{grid[0], grid[1], grid[2], constants[3],
                                       gpu::Constant(4, variant.light_textured), constants[8], constants[9]});
  }
  loaded_ = variant;
}

std::optional<frame::Refusal> VsvOptions::refusal(const scene::View& view) const {
  if (scene::has_g(view.medium.phase) && std::abs(view.medium.g) > k_narrowest_lobe) {
    return frame::Refusal{{},
                          fmt::format("it cannot follow the lobe of g = {:g}: the limit is |g| = {:g}",
                                      view.medium.g, k_narrowest_lobe),
                          "use a g nearer to 0, or the method reference"};
  }
  const bool is_textured = std::any_of(view.lights.begin(), view.lights.end(),
                                       [](const scene::Light& light) { return light.texture != nullptr; });
  if (!is_textured || integral == VsvIntegral::riemann) return {};
  return frame::Refusal{integral == VsvIntegral::table ? "integral=table" : "integral=factored",
                        "it cannot take a light texture", "use vsv:integral=riemann"};
}

void Vsv::integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) {
  assert(!options_.refusal(inputs.view));
  const bool has_table = options_.integral != VsvIntegral::riemann;
  const gpu::Texture* light_texture = inputs.light_texture();

  // Where the grid's rows lie, and what the shaders are specialised for.
  const shaders::EpipolarBlock space = volume_.find_ranges(inputs);
  const glm::vec3 sigma_t = inputs.view.medium.sigma_s + inputs.view.medium.sigma_a;
  const bool is_grey = sigma_t.x == sigma_t.y && sigma_t.y == sigma_t.z;
  load(inputs.context, {static_cast<std::uint32_t>(inputs.view.medium.phase), is_grey ? 1u : 3u,
                        direct_cells(space, volume_.grid().resolution()), light_texture != nullptr,
                        is_rough(inputs.view.medium, space.distance)});
  if (options_.phi_cells == PhiCells::growing)
    inputs.timer.time("ranges", [&] { phi_growth_.dispatch({1, 1, 1}); });

  // Visibility.
  volume_.fill(inputs);

  // Radiance.
  if (has_table) {
    inputs.timer.time("table", [&] {
      table_.bind_storage(shaders::k_table_storage);
      build_table_.dispatch({table_rows(loaded_->rough), 1, 1});
    });
  }
  inputs.timer.time("integrate", [&] {
    inputs.surfaces.bind_sampler(shaders::k_surface_unit);
    if (has_table) table_texels_.bind_sampler(shaders::k_table_unit);
    if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
    integrate_.run({radiance});
  });
}

std::map<std::string, std::int64_t> Vsv::bytes() const {
  std::map<std::string, std::int64_t> bytes = volume_.bytes();
  if (options_.integral != VsvIntegral::riemann) bytes["table"] = table_.bytes();
  return bytes;
}

std::vector<frame::DebugImage> Vsv::debug_images(const frame::FrameInputs& inputs) {
  return epipolar::debug_images(volume_, inputs);
}

frame::AirlightMethod vsv_method() {
  std::vector<frame::Option> options = {frame::word_option(
      {.name = "integral",
       .meaning = "how visibility becomes radiance",
       .quality = "table is exact up to the bits, riemann to a cell; factored does not ask where shadow lies",
       .cost = "table grows with the changes of visibility a pixel, riemann with the lit samples",
       .sweep = {"table", "riemann", "factored"},
       .is_common = true},
      {{"table", "between changes of visibility, from a table"},
       {"riemann", "the paper's sum over lit samples"},
       {"factored", "the lit fraction of what would be without shadow"}},
      &VsvOptions::integral)};
  for (frame::Option& option : frame::options_of(&VsvOptions::volume, epipolar::volume_options()))
    options.push_back(std::move(option));
  options.push_back(frame::word_option({.name = "phi-cells",
                                        .meaning = "cells of the grid along the light angle",
                                        .quality = "growing ones are finer where more light comes from",
                                        .cost = "none",
                                        .sweep = {"growing", "equal"}},
                                       {{"growing"}, {"equal", "the paper's"}}, &VsvOptions::phi_cells));
  return frame::describe<frame::Airlight, VsvOptions>(
      "vsv", "epipolar voxelized shadow volumes", {}, std::move(options),
      [](const gpu::Context& context, const VsvOptions& vsv) { return std::make_unique<Vsv>(context, vsv); });
}

}  // namespace airlight::media
