#include "epipolar/volume.h"

#include <algorithm>
#include <cstring>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "scene/error.h"

#include "spirv/epipolar/phi_range_comp.h"
#include "spirv/epipolar/phi_range_listed_comp.h"
#include "spirv/epipolar/plane_cells_comp.h"
#include "spirv/epipolar/plane_range_comp.h"
#include "spirv/epipolar/planes_comp.h"
#include "spirv/epipolar/scatter_comp.h"

namespace airlight::epipolar {

namespace {

/// `given` with what is automatic, 0, taken from `automatic`.
Resolution resolved(Resolution given, const Resolution& automatic) {
  for (const auto count : {&Resolution::alpha, &Resolution::theta, &Resolution::phi})
    if (given.*count == 0) given.*count = automatic.*count;
  return given;
}

/// How far a light ray whose bits a pixel reads may lie beside the directions from the light to what the
/// camera sees [rad]: half a cell, where cells are widest. Ranges beyond the frame's are asked for to see
/// them whole.
double reach_of_light_rays(const VolumeOptions& options) {
  using std::numbers::pi;
  if (options.ranges != Ranges::frame) return pi;
  const double widest_theta = 2.0 * pi / options.resolution.theta / (1.0 - k_most_theta_growth);
  const double widest_phi = 2.0 * pi / options.resolution.phi;  // see shaders::PhiCells
  return 0.5 * (widest_theta + widest_phi);
}

}  // namespace

Scan VolumeOptions::used_scan() const {
  return scan.value_or(query != Query::bits                 ? Scan::none
                       : populate == Populate::screen_space ? Scan::column
                                                            : Scan::fused);
}

Resolution VolumeOptions::used_resolution() const {
  Resolution used = resolution;
  if (query != Query::bits) used.alpha = k_tree_alpha;
  return used;
}

void VolumeOptions::validate() const {
  epipolar::validate(resolved(resolution, {}));
  const bool is_blocks = used_scan() == Scan::blocks;
  if (populate == Populate::screen_space && (used_scan() == Scan::fused || is_blocks)) {
    throw scene::Error(scene::ExitCode::usage, is_blocks ? "scan=blocks" : "scan=fused",
                       "the screen-space voxelization sets bits, and this scan reads none",
                       "use column or multi-pass");
  }
  if (is_blocks && resolution.alpha > k_most_block_alpha) {
    throw scene::Error(scene::ExitCode::usage, fmt::format("alpha={}", resolution.alpha),
                       fmt::format("scan=blocks takes {} at most", k_most_block_alpha),
                       "ask for fewer, or use scan=fused");
  }
  if ((used_scan() == Scan::none) != (query != Query::bits)) {
    throw scene::Error(scene::ExitCode::usage, "scan",
                       query != Query::bits ? "query=tree asks no bits that a scan would make"
                                            : "only query=tree goes without one",
                       "leave it out");
  }
  if (query == Query::bits) return;
  if (populate == Populate::screen_space) {
    throw scene::Error(scene::ExitCode::usage, "populate=screen-space",
                       "it sets bits, and query=tree is made from the first occluder of each light ray",
                       "use shadow-map or conservative, or query=bits");
  }
  if (query == Query::tree && resolution.phi > k_most_tree_phi) {
    throw scene::Error(scene::ExitCode::usage, fmt::format("phi={}", resolution.phi),
                       fmt::format("query=tree takes {} at most", k_most_tree_phi),
                       "ask for fewer, or use query=bits");
  }
}

void VolumeOptions::fit(const scene::View& view) {
  Resolution automatic;
  for (const scene::Light& light : view.lights) {
    const Resolution exact = pixel_exact(view, light, ranges, theta_cells);
    automatic.alpha = &light == &view.lights[0] ? exact.alpha : std::max(automatic.alpha, exact.alpha);
    automatic.theta = &light == &view.lights[0] ? exact.theta : std::max(automatic.theta, exact.theta);
  }
  resolution = resolved(resolution, automatic);
}

std::vector<frame::Option> volume_options() {
  using frame::Option;
  std::vector<Option> options = {
      frame::word_option<VolumeOptions, Populate>(
          {.name = "populate",
           .meaning = "what fills the grid",
           .quality = "shadow-map errs either way, conservative never leaks, screen-space needs closed parts",
           .cost = "shadow-map is the cheapest, the others grow with the triangles",
           .sweep = {"shadow-map", "conservative"},
           .is_common = true},
          {{"shadow-map", "one look-up a light ray"},
           {"conservative", "every voxel that a triangle touches"},
           {"screen-space", "the inside of watertight parts"}},
          &VolumeOptions::populate),
      frame::word_option<VolumeOptions, Scan>(
          {.name = "scan",
           .meaning = "how shadow is drawn out along light rays",
           .quality = "none: the same bits",
           .cost = "fused only writes, blocks the least, for a fetch more a look-up; column reads and writes "
                   "once; "
                   "multi-pass moves five times the grid",
           .sweep = {"fused", "blocks", "column", "multi-pass"}},
          {{"fused", "one pass that only writes; default but for screen-space"},
           {"blocks", "the same, less what of 128 light rays is lit or dark alike"},
           {"column", "one pass over set bits"},
           {"multi-pass", "the paper's"},
           {"none", "of query=tree"}},
          [](const VolumeOptions& volume) { return volume.used_scan(); },
          [](VolumeOptions& volume, Scan scan) { volume.scan = scan; }),
      frame::word_option<VolumeOptions, Ranges>(
          {.name = "ranges",
           .meaning = "angles that the grid covers",
           .quality = "what is not seen takes no cells from what is",
           .cost = "none",
           .sweep = {"frame", "full"}},
          {{"frame", "what is seen"}, {"alpha-phi", "the paper's: all theta"}, {"full"}},
          &VolumeOptions::ranges)};
  const frame::Counts any = {.most = k_largest_count,
                             .automatic = "at most a pixel apart, fewer where the scene needs no more"};
  const frame::Counts whole_texels = {
      .least = 128, .most = k_largest_count, .multiple_of = 128, .automatic = "what the scene needs"};
  for (Option& count : frame::options_of(
           &VolumeOptions::resolution, {frame::count_option({.name = "alpha",
                                       .meaning = "cells of the grid along the view angle",
                                       .quality = "too few show as jagged shadow edges",
                                       .cost = "memory, scan; query=tree has 65535",
                                       .sweep = {"64", "128", "256", "512"},
                                       .is_common = true},
                                                            any, &Resolution::alpha),
                                        frame::count_option({.name = "theta",
                                        .meaning = "half-planes of the grid about the axis from eye to light",
                                        .quality = "too few show as streaks around the epipole",
                                        .cost = "memory, populate, scan",
                                        .sweep = {"256", "512", "1024", "2048"},
                                        .is_common = true},
                                                            any, &Resolution::theta),
                                        frame::count_option({.name = "phi",
                                        .meaning = "cells of the grid along the light angle",
                                        .quality = "too few show as noise and missed thin occluders",
                                        .cost = "memory, populate, scan, integrate",
                                        .sweep = {"128", "256", "512", "1024"},
                                        .is_common = true},
                                                            whole_texels, &Resolution::phi)}))
    options.push_back(std::move(count));
  // A tree has its own count of α.
  Option& alpha = *std::find_if(options.begin(), options.end(),
                                [](const Option& option) { return option.text.name == "alpha"; });
  alpha.get = [get = alpha.get](const void* volume) -> frame::OptionValue {
    const auto& of_volume = *static_cast<const VolumeOptions*>(volume);
    return of_volume.query == Query::tree ? of_volume.used_resolution().alpha : get(volume);
  };
  options.push_back(frame::word_option<VolumeOptions, ThetaCells>(
      {.name = "theta-cells",
       .meaning = "half-planes of the grid",
       .quality = "fitted ones serve the pixels far from the epipole better",
       .cost = "none",
       .sweep = {"fitted", "equal"}},
      {{"fitted", "denser where they reach farther"}, {"equal", "the paper's"}},
      &VolumeOptions::theta_cells));
  return options;
}

frame::Option query_option() {
  return frame::word_option(
      {.name = "query",
       .meaning = "what a view ray is answered from",
       .quality = "a tree knows each pixel's own alpha, bits that of their row",
       .cost = "a tree saves the scan and the grid's memory, and takes some nodes for each change",
       .sweep = {"bits", "tree"},
       .is_common = false},
      {{"bits", "the voxels of its row"}, {"tree", "a min-max tree over light rays"}}, &VolumeOptions::query);
}

ShadowVolume::ShadowVolume(const gpu::Limits& limits, const VolumeOptions& options)
    : options_(options),
      grid_(limits, options.used_resolution(), options.query == Query::bits),
      planes_(gpu::Pipeline::compute(k_planes_comp, resolution_constants(grid_.resolution()))),
      phi_range_(gpu::Pipeline::compute(k_phi_range_comp, resolution_constants(grid_.resolution()))),
      plane_cells_(gpu::Pipeline::compute(k_plane_cells_comp, resolution_constants(grid_.resolution()))),
      plane_range_(gpu::Pipeline::compute(k_plane_range_comp, resolution_constants(grid_.resolution()))),
      scatter_(gpu::Pipeline::compute(k_scatter_comp, resolution_constants(grid_.resolution()))) {
  options.validate();
  switch (options.populate) {
    case Populate::shadow_map:
      populate_shadow_map_.emplace();
      break;
    case Populate::conservative:
      populate_conservative_.emplace(grid_.resolution());
      break;
    case Populate::screen_space:
      populate_screen_space_.emplace(limits, grid_);
      break;
  }
  switch (options.used_scan()) {
    case Scan::fused:
    case Scan::blocks:
      fused_scan_.emplace(limits, grid_.resolution(), options.used_scan() == Scan::blocks);
      break;
    case Scan::column:
      or_scan_.emplace(grid_.resolution());
      break;
    case Scan::multi_pass:
      mip_scan_.emplace(limits, grid_);
      break;
    case Scan::none:
      if (options.query == Query::tree) tree_.emplace(limits, grid_.resolution());
      break;
  }
}

bool ShadowVolume::Source::operator==(const Source& other) const {
  return scene == other.scene && scene::shine_alike(light, other.light) && medium == other.medium &&
         eye == other.eye && std::memcmp(&block, &other.block, sizeof block) == 0 && image == other.image;
}

ShadowVolume::Source ShadowVolume::source_of(const frame::FrameInputs& inputs,
                                             const shaders::EpipolarBlock& block) const {
  const scene::View& view = inputs.view;
  Source source{.scene = inputs.scene.id(),
                .light = inputs.light(),
                .eye = view.camera.eye,
                .block = block,
                .medium = view.medium,
                .image = {}};
  if (options_.ranges != Ranges::full || inputs.shadow_map_is_plane())
    source.image = {scene::camera_frame(view.camera, view.size), view.size};
  return source;
}

shaders::EpipolarBlock ShadowVolume::find_ranges(const frame::FrameInputs& inputs, bool own_ranges) {
  shaders::EpipolarBlock block =
      epipolar_block(inputs.view, inputs.light(), grid_.resolution(), options_.ranges, options_.theta_cells);
  if (!own_ranges) block.own_ranges = 0.0f;
  if (populate_screen_space_) {
    // It finds occluders on the grid's own view rays, those nearer the axis than the image included.
    const auto count = static_cast<float>(grid_.resolution().alpha);
    const shaders::Angle end = shaders::alpha_of_cell(block, shaders::Cell(count));
    block.alpha_min = shaders::Angle(0.0f);
    block.alpha_step = shaders::spaced_alpha(block, end) / count;
  }
  found_ = source_of(inputs, block);
  rests_ = inputs.resources.keeps() && filled_ == found_;
  if (rests_) {
    bind();
    return block;
  }
  filled_.reset();
  inputs.timer.time("ranges", [&] {
    grid_.block().write(&block, sizeof block);
    grid_.phi_range().clear();
    bind();
    grid_.planes().bind_storage(shaders::k_planes_storage);
    planes_.dispatch({grid_.resolution().theta, 1, 1});
    const int planes = grid_.resolution().theta;
    std::vector<glm::vec2> ranges = box_ranges(inputs.scene.box(), inputs.view.camera.eye, block, planes);
    if (options_.ranges == Ranges::full) {
      // Every φ there is, and that a view ray can end at.
      const float endless = shaders::is_sun(block) ? static_cast<float>(shaders::k_endless_phi) : 2.0f;
      std::vector<float> range(2 + static_cast<std::size_t>(planes), endless);
      range[0] = range[1] = 0.0f;
      grid_.phi_range().write(range.data(), grid_.phi_range().bytes());
      if (!shaders::is_sun(block))
        ranges.assign(ranges.size(), glm::vec2(0.0f, static_cast<float>(shaders::k_half_turn)));
    } else {
      inputs.ray_surfaces().bind_sampler(shaders::k_surface_unit);
      if (inputs.listed) {
        if (!phi_range_listed_)
          phi_range_listed_ =
              gpu::Pipeline::compute(k_phi_range_listed_comp, resolution_constants(grid_.resolution()));
        phi_range_listed_->dispatch({(inputs.listed->most + 31) / 32, 1, 1});
      } else {
        const glm::uvec2 size = inputs.view.size;
        phi_range_.dispatch({size.x, (size.y + 31) / 32, 1});
      }
    }
    grid_.box_ranges().write(ranges.data(), planes * 8);
    grid_.bind_box_ranges();
    plane_range_.dispatch({planes, 1, 1});
  });
  return block;
}

void ShadowVolume::bind() const {
  grid_.bind();
  if (fused_scan_) fused_scan_->bind();
  if (tree_) tree_->bind();
}

void ShadowVolume::fill_unscanned(const frame::FrameInputs& inputs, bool with_bits) {
  grid_.planes().bind_storage(shaders::k_planes_storage);
  plane_cells_.dispatch({grid_.resolution().theta, 1, 1});
  if (populate_screen_space_) populate_screen_space_->run(inputs, grid_);
  if (populate_shadow_map_) populate_shadow_map_->run(grid_, inputs, reach_of_light_rays(options_));
  if (populate_conservative_) populate_conservative_->run(grid_, inputs.scene, inputs.triangles_at_light());
  if (with_bits && !populate_screen_space_) {
    grid_.bits().clear();
    dispatch_planes(scatter_, grid_, grid_.resolution().phi / 32);
  }
}

void ShadowVolume::fill(const frame::FrameInputs& inputs) {
  if (rests_) return;
  inputs.timer.time("populate", [&] { fill_unscanned(inputs, or_scan_ || mip_scan_); });
  if (tree_) inputs.timer.time("tree", [&] { tree_->build(); });
  if (options_.query == Query::bits)
    inputs.timer.time("scan", [&] {
      if (fused_scan_) fused_scan_->run(grid_);
      if (or_scan_) or_scan_->run(grid_);
      if (mip_scan_) mip_scan_->run(grid_);
    });
  filled_ = found_;
  inputs.resources.note_redrawn("volume");
}

std::vector<std::uint32_t> ShadowVolume::bits() const {
  return fused_scan_ ? fused_scan_->bits(grid_) : grid_.bits().read<std::uint32_t>();
}

std::array<gpu::Constant, 4> ShadowVolume::reader_constants() const {
  const auto counts = resolution_constants(grid_.resolution());
  return {counts[0], counts[1], counts[2], gpu::Constant(23, options_.used_scan() == Scan::blocks)};
}

std::optional<std::int64_t> ShadowVolume::scanned_bytes() const {
  if (!fused_scan_) return {};
  return fused_scan_->written_bytes(grid_);
}

std::map<std::string, std::int64_t> ShadowVolume::bytes() const {
  std::map<std::string, std::int64_t> bytes = {{"light_rays", grid_.first_shadowed().bytes()}};
  if (tree_) bytes["change_tree"] = tree_->nodes().bytes();
  if (options_.query == Query::bits) bytes["grid"] = grid_.bits().bytes();
  if (fused_scan_ && fused_scan_->blocks().bytes() > 0) bytes["blocks"] = fused_scan_->blocks().bytes();
  if (populate_screen_space_) bytes["crossings"] = populate_screen_space_->bytes();
  if (mip_scan_) bytes["mip_chain"] = mip_scan_->bytes();
  return bytes;
}

}  // namespace airlight::epipolar
