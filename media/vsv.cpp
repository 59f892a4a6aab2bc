#include "media/vsv.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <span>

#include <fmt/format.h>

#include "epipolar/debug_images.h"
#include "media/lighting.h"
#include "media/medium.h"
#include "scene/light_texture.h"

#include "spirv/media/phi_growth_comp.h"
#include "spirv/media/vsv_colour_build_comp.h"
#include "spirv/media/vsv_count_frag.h"
#include "spirv/media/vsv_quadrature_frag.h"
#include "spirv/media/vsv_riemann_frag.h"
#include "spirv/media/vsv_sun_frag.h"
#include "spirv/media/vsv_table_build_comp.h"
#include "spirv/media/vsv_table_frag.h"

namespace airlight::media {
namespace {

/// Rows of the table in α. With lobes of |g| ≤ 0.8, 128 rows err by up to 0.03 % of an image of empty fog
/// (rrmse, as all of these); 512 rows by 0.3 % with |g| = 0.99, by 0.8 % with the narrowest lobe that is
/// taken.
std::uint32_t table_rows(bool rough) {
  return rough ? 512 : 128;
}

/// Rows and columns of the table of a light texture's colours (shaders/media/vsv_colour.glsl): 16 rows and a
/// column for each of the texture's. Half the rows err by 0.16 % of what a light a few texels wide sends past
/// the fence of docs/figures.md, these by 0.06 %; the columns matter less. 64 MiB at most.
std::array<std::uint32_t, 2> colours_of(const scene::Light& light) {
  if (!light.texture) return {0, 0};
  const auto height = static_cast<std::uint32_t>(light.texture->size().y);
  return {std::clamp(16 * height, 1024u, 4096u), std::clamp(height, 256u, 1024u)};
}

/// What of a light no table of α and φ alone holds; nullptr for nothing.
const char* beyond_tables(const scene::View& view, const scene::Light& light) {
  if (light.texture) return "a light texture";
  if (light.cone) return "a spot";
  if (light.range) return "a light's range";
  if (layer_of(view.medium, light, view.camera.eye) == shaders::k_layer_entered)
    return "a point light or an eye above a layer of fog";
  return nullptr;
}

shaders::Angle alpha_max(const shaders::EpipolarBlock& space, const epipolar::Resolution& resolution) {
  return shaders::alpha_of_cell(space, shaders::Cell(static_cast<float>(resolution.alpha)));
}

/// How many cells a ray must cross for the table to serve it: 0, any will do, unless the view comes so near
/// to α = π, where φ_d ≤ π − α, that its rays may end within four of the widest cells.
std::uint32_t direct_cells(const shaders::EpipolarBlock& space, const epipolar::Resolution& resolution) {
  constexpr std::uint32_t k_cells = 4;
  constexpr float k_widest = 1.8f;  // of φ_max / N_φ, at the largest growth (shaders/media/phi_growth.comp)
  const shaders::Angle reach = k_cells * k_widest * shaders::k_half_turn / static_cast<float>(resolution.phi);
  return shaders::k_half_turn - alpha_max(space, resolution) < reach ? k_cells : 0;
}

}  // namespace

Vsv::Vsv(const gpu::Context& context, const VsvOptions& options)
    : options_(options), volume_(context.limits(), options.volume) {}

const Vsv::Programs& Vsv::load(const gpu::Context& context, const Variant& variant) {
  if (const auto found = programs_.find(variant); found != programs_.end()) return found->second;
  Programs programs;
  const epipolar::Resolution& resolution = volume_.grid().resolution();
  const auto grid = volume_.reader_constants();
  const gpu::Constant phase(3, variant.phase), channels(4, variant.channels);
  const gpu::Constant whole_voxels(8, options_.volume.populate == epipolar::Populate::conservative);
  const gpu::Constant query(17, static_cast<std::uint32_t>(options_.volume.query));
  const gpu::Constant rough(9, variant.rough), layer(10, variant.layer), looks_away(11, variant.looks_away);
  const gpu::Constant reach(12, variant.reach), light_textured(13, variant.colour_rows > 0);
  const gpu::Constant colour_rows(14, variant.colour_rows), colour_columns(15, variant.colour_columns);
  const auto require_table = [&](std::int64_t bytes, const char* what) {
    if (table_.bytes() >= bytes) return;
    table_ = gpu::Buffer(bytes);
    table_texels_ = {context.limits(), table_, gpu::Format::rgba32f, what};
  };
  programs.of_ray = {grid[0], grid[1], grid[2], grid[3], phase, whole_voxels, layer, looks_away, query};
  const auto pass = [&](std::span<const std::uint32_t> fragment, std::initializer_list<gpu::Constant> more) {
    std::vector<gpu::Constant> constants = programs.of_ray;
    constants.insert(constants.end(), more);
    return frame::ray_pass(options_.rays, fragment, constants);
  };
  programs.phi_growth = gpu::Pipeline::compute(k_phi_growth_comp, std::array{grid[0], phase});
  if (variant.sun) {
    // In the order of shaders/media/vsv_sun.frag.
    const std::uint32_t sum = variant.integral == VsvIntegral::riemann    ? 1
                              : variant.integral == VsvIntegral::factored ? 2
                                                                          : 0;
    programs.integrate = pass(k_vsv_sun_frag, {gpu::Constant(6, sum)});
  } else if (variant.integral == VsvIntegral::riemann) {
    programs.integrate = pass(k_vsv_riemann_frag, {rough, reach, light_textured});
  } else if (variant.integral == VsvIntegral::quadrature) {
    programs.integrate =
        pass(k_vsv_quadrature_frag, {channels, reach, light_textured, colour_rows, colour_columns});
    if (variant.colour_rows > 0) {
      programs.build_table =
          gpu::Pipeline::compute(k_vsv_colour_build_comp, std::array{colour_rows, colour_columns});
      programs.table_rows = variant.colour_rows;
      require_table(std::int64_t{variant.colour_rows} * (variant.colour_columns + 1) * 16,
                    "the table of the light's colours");
    }
  } else {
    programs.table_rows = table_rows(variant.rough);
    const gpu::Constant rows(5, programs.table_rows), direct(6, variant.direct);
    const gpu::Constant factored(7, variant.integral == VsvIntegral::factored);
    programs.build_table = gpu::Pipeline::compute(
        k_vsv_table_build_comp, std::array{grid[0], grid[1], grid[2], phase, channels, rows, rough});
    programs.integrate = pass(k_vsv_table_frag, {channels, rows, direct, factored, rough});
    require_table(std::int64_t{programs.table_rows} * (resolution.phi + 2) * variant.channels * 16,
                  "the table integral");
  }
  return programs_.emplace(variant, std::move(programs)).first->second;
}

VsvIntegral VsvOptions::used_integral(const scene::View& view) const {
  if (integral != VsvIntegral::automatic) return integral;
  const bool has_table = std::none_of(view.lights.begin(), view.lights.end(), [&](const scene::Light& light) {
    return beyond_tables(view, light) != nullptr;
  });
  return has_table ? VsvIntegral::table : VsvIntegral::quadrature;
}

void VsvOptions::validate() const {
  volume.validate();
  if (volume.query == epipolar::Query::tree &&
      (integral == VsvIntegral::riemann || integral == VsvIntegral::factored)) {
    throw scene::Error(scene::ExitCode::usage,
                       integral == VsvIntegral::riemann ? "integral=riemann" : "integral=factored",
                       "it counts samples one by one, and query=tree finds changes of visibility",
                       "use table or quadrature, or query=bits");
  }
}

std::optional<frame::Refusal> VsvOptions::refusal(const scene::View& view) const {
  if (auto narrow = narrow_lobe(view.medium)) return narrow;
  if (integral != VsvIntegral::table && integral != VsvIntegral::factored) return {};
  for (const scene::Light& light : view.lights) {
    if (const char* what = beyond_tables(view, light)) {
      return frame::Refusal{integral == VsvIntegral::table ? "integral=table" : "integral=factored",
                            fmt::format("it cannot take {}", what), "use vsv:integral=quadrature"};
    }
  }
  return {};
}

void Vsv::integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) {
  assert(!options_.refusal(inputs.view) && options_.rays.are_listed() == inputs.listed.has_value());
  const VsvIntegral integral = options_.used_integral(inputs.view);
  const bool is_sun = scene::is_sun(inputs.light());
  const bool has_table = !is_sun && (integral == VsvIntegral::table || integral == VsvIntegral::factored);
  const gpu::Texture* light_texture = inputs.light_texture();

  // Where the grid's rows lie, and what the shaders are specialised for.
  const std::uint32_t layer = layer_of(inputs.view.medium, inputs.light(), inputs.view.camera.eye);
  const bool rough = !is_sun && is_rough(inputs, layer);
  const shaders::EpipolarBlock space = volume_.find_ranges(inputs, !(rough && has_table));
  const glm::vec3 sigma_t = inputs.view.medium.sigma_s + inputs.view.medium.sigma_a;
  const bool is_grey = sigma_t.x == sigma_t.y && sigma_t.y == sigma_t.z;
  const auto [colour_rows, colour_columns] = colours_of(inputs.light());
  const Programs& programs =
      load(inputs.context,
           {.integral = integral,
            .phase = static_cast<std::uint32_t>(inputs.view.medium.phase),
            .channels = is_grey ? 1u : 3u,
            .direct = direct_cells(space, volume_.grid().resolution()),
            .reach = reach_of(inputs.light()),
            .colour_rows = colour_rows,
            .colour_columns = colour_columns,
            .rough = rough,
            .sun = is_sun,
            .layer = layer,
            .looks_away = alpha_max(space, volume_.grid().resolution()) > 0.5f * shaders::k_half_turn});
  last_ = &programs;
  if (options_.phi_cells == PhiCells::growing && !volume_.rests())
    inputs.timer.time("ranges", [&] { programs.phi_growth.dispatch({1, 1, 1}); });

  // Visibility.
  volume_.fill(inputs);

  // Radiance.
  if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
  if (programs.table_rows > 0 && !volume_.rests()) {
    inputs.timer.time("table", [&] {
      table_.bind_storage(shaders::k_table_storage);
      programs.build_table.dispatch({programs.table_rows, 1, 1});
    });
  }
  inputs.timer.time("integrate", [&] {
    inputs.ray_surfaces().bind_sampler(shaders::k_surface_unit);
    if (programs.table_rows > 0) table_texels_.bind_sampler(shaders::k_table_unit);
    programs.integrate.run({radiance});
  });
}

std::map<std::string, std::int64_t> Vsv::bytes() const {
  std::map<std::string, std::int64_t> bytes = volume_.bytes();
  if (table_.bytes() > 0) bytes["table"] = table_.bytes();
  return bytes;
}

gpu::Texture Vsv::count(const frame::FrameInputs& inputs) const {
  const frame::ScreenPass pass = frame::ray_pass(options_.rays, k_vsv_count_frag, last_->of_ray);
  gpu::Texture counts(gpu::Format::rgba32f, inputs.ray_surfaces().size());
  counts.clear();
  inputs.ray_surfaces().bind_sampler(shaders::k_surface_unit);
  pass.run({counts});
  return counts;
}

std::map<std::string, double> Vsv::counters(const frame::FrameInputs& inputs) {
  double changes = 0.0, reads = 0.0;
  for (const glm::vec4& ray : count(inputs).read<glm::vec4>()) {
    changes += static_cast<double>(ray.x);
    reads += static_cast<double>(ray.y);
  }
  std::map<std::string, double> counters = {{"changes", changes}, {"reads", reads}};
  if (const auto scanned = volume_.scanned_bytes()) counters["scanned_bytes"] = static_cast<double>(*scanned);
  return counters;
}

std::vector<frame::DebugImage> Vsv::debug_images(const frame::FrameInputs& inputs) {
  if (inputs.listed) return epipolar::debug_images(volume_, inputs);
  constexpr float k_most = 64.0f;
  const gpu::Texture counts = count(inputs);
  frame::DebugImage changes{"changes", "changes of visibility along each view ray, of 64", counts.size(), {}};
  for (const glm::vec4& ray : counts.read<glm::vec4>())
    changes.values.push_back(std::min(ray.x / k_most, 1.0f));
  std::vector<frame::DebugImage> images = epipolar::debug_images(volume_, inputs);
  images.push_back(std::move(changes));
  return images;
}

std::optional<frame::DebugImage> Vsv::debug_slice(const scene::View& view, glm::dvec2 place) {
  if (!last_ || options_.volume.populate == epipolar::Populate::screen_space) return {};
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const glm::dvec3 ray = scene::image_ray(camera, view.size, place);
  return epipolar::debug_slice(volume_, glm::vec3(glm::normalize(ray)));
}

frame::AirlightMethod vsv_method() {
  std::vector<frame::Option> options = {frame::word_option(
      {.name = "integral",
       .meaning = "how visibility becomes radiance",
       .quality =
           "table and quadrature are exact up to the bits, riemann to a cell; factored does not ask where "
           "shadow lies",
       .cost =
           "table and quadrature grow with the changes of visibility a pixel, riemann with the lit samples",
       .sweep = {"table", "quadrature", "riemann", "factored"},
       .is_common = true},
      {{"auto", "table for a view that it can serve, else quadrature"},
       {"table", "between changes of visibility, from a table"},
       {"quadrature", "between changes of visibility, by panels that follow the light"},
       {"riemann", "the paper's sum over lit samples"},
       {"factored", "the lit fraction of what would be without shadow"}},
      &VsvOptions::integral)};
  for (frame::Option& option : frame::options_of(&VsvOptions::volume, epipolar::volume_options()))
    options.push_back(std::move(option));
  for (frame::Option& option : frame::options_of(&VsvOptions::volume, {epipolar::query_option()}))
    options.push_back(std::move(option));
  options.push_back(frame::word_option({.name = "phi-cells",
                                        .meaning = "cells of the grid along the light angle",
                                        .quality = "growing ones are finer where more light comes from",
                                        .cost = "none",
                                        .sweep = {"growing", "equal"}},
                                       {{"growing"}, {"equal", "the paper's"}}, &VsvOptions::phi_cells));
  for (frame::Option& option : frame::options_of(&VsvOptions::rays, frame::view_rays_options()))
    options.push_back(std::move(option));
  return frame::describe<frame::Airlight, VsvOptions>(
      "vsv", "epipolar voxelized shadow volumes", {}, std::move(options),
      [](const gpu::Context& context, const VsvOptions& vsv) { return std::make_unique<Vsv>(context, vsv); });
}

}  // namespace airlight::media
