#include "media/froxel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frame/blocks.h"
#include "scene/error.h"

#include "spirv/media/froxel_read_frag.h"
#include "spirv/media/froxel_scatter_comp.h"
#include "spirv/media/froxel_sum_comp.h"

namespace airlight::media {
namespace {

/// Optical depth at which the last slice ends: what is left is e^−7, a thousandth.
constexpr double k_deepest_slice = 7.0;

/// Of what was found before, against what a frame finds itself: Wronski's 0.05.
constexpr float k_history_weight = 0.95f;
constexpr int k_jittered_frames = 16;  ///< until look-ups lie where they were

scene::Error too_many(const FroxelOptions& options, glm::ivec3 count, const std::string& limit) {
  return scene::Error(scene::ExitCode::driver,
                      fmt::format("froxel:tile={}:slices={}", options.tile, options.slices),
                      fmt::format("{} x {} x {} froxels are more than {}", count.x, count.y, count.z, limit),
                      "use larger tiles or fewer slices");
}

}  // namespace

glm::ivec3 froxel_count(const gpu::Limits& limits, const FroxelOptions& options, glm::ivec2 image_size) {
  const glm::ivec3 count((image_size + options.tile - 1) / options.tile, options.slices);
  if (std::max({count.x, count.y, count.z}) > limits.max_volume_size)
    throw too_many(options, count,
                   fmt::format("this driver's {} a side (GL_MAX_3D_TEXTURE_SIZE)", limits.max_volume_size));
  return count;
}

double farthest_slice(const scene::View& view, const scene::Light& light, const scene::Box& box) {
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  double depth = 0.0;
  if (!box.empty()) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 at((corner & 1) != 0 ? box.upper.x : box.lower.x,
                          (corner & 2) != 0 ? box.upper.y : box.lower.y,
                          (corner & 4) != 0 ? box.upper.z : box.lower.z);
      depth = std::max(depth, glm::dot(at - camera.eye, camera.forward));
    }
  }
  if (depth <= 0.0) depth = scene::is_sun(light) ? 1.0 : 2.0 * glm::distance(camera.eye, light.position);
  const glm::vec3 sigma_t = view.medium.sigma_s + view.medium.sigma_a;
  const double thinnest = static_cast<double>(std::min({sigma_t.x, sigma_t.y, sigma_t.z}));
  return thinnest * depth > k_deepest_slice ? k_deepest_slice / thinnest : depth;
}

Froxel::Froxel(const FroxelOptions& options)
    : options_(options),
      space_(sizeof(shaders::EpipolarBlock)),
      history_block_(sizeof(shaders::FroxelHistoryBlock)) {}

const Froxel::Programs& Froxel::load(const Variant& variant) {
  if (const auto found = programs_.find(variant); found != programs_.end()) return found->second;
  const std::vector<gpu::Constant> constants = {{3, variant.phase},
                                                {10, variant.layer},
                                                {12, variant.reach},
                                                {13, variant.light_textured},
                                                {16, variant.plane},
                                                {18, variant.sun},
                                                {21, static_cast<std::uint32_t>(options_.tile)},
                                                {22, variant.history}};
  return programs_
      .emplace(variant, Programs{gpu::Pipeline::compute(k_froxel_scatter_comp, constants),
                                 gpu::Pipeline::compute(k_froxel_sum_comp, constants),
                                 frame::ScreenPass(k_froxel_read_frag, constants)})
      .first->second;
}

void Froxel::begin_history(const frame::FrameInputs& inputs, glm::ivec3 count, float farthest) {
  const scene::View& view = inputs.view;
  const scene::Light& light = inputs.light();
  if (histories_.size() <= inputs.light_index) histories_.resize(inputs.light_index + 1);
  History& history = histories_[inputs.light_index];
  if (!inputs.resources.keeps() || history.lit.extent() != count || history.scene != inputs.scene.id() ||
      history.light != light.name || history.is_sun != scene::is_sun(light))
    history.frames = 0;
  for (gpu::Texture* texture : {&history.lit, &lit_}) {
    if (texture->extent() == count) continue;
    *texture = gpu::Texture::volume(gpu::Format::r32f, count);
    texture->sample_linearly();
  }

  // The first frames count alike: one of them that had nearly all weight would be seen for long.
  const auto frames = static_cast<float>(history.frames);
  history.seen.weight = std::min(frames / (frames + 1.0f), k_history_weight);
  history.seen.first_look_up =
      static_cast<std::uint32_t>(history.frames % k_jittered_frames * options_.samples);
  history_block_.write(&history.seen, sizeof history.seen);
  history_block_.bind_uniform(shaders::k_froxel_history_block);
  history.lit.bind_sampler(shaders::k_scratch_unit);
  lit_.bind_image(shaders::k_lit_image);

  ++history.frames;
  history.scene = inputs.scene.id();
  history.light = light.name;
  history.is_sun = scene::is_sun(light);
  history.seen.camera = frame::camera_block(scene::camera_frame(view.camera, view.size), view.size, 0.0f);
  history.seen.far = farthest;
  std::swap(history.lit, lit_);
}

void Froxel::integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) {
  assert(!options_.refusal(inputs.view));
  const scene::View& view = inputs.view;
  const scene::Light& light = inputs.light();
  const glm::ivec3 count = froxel_count(inputs.context.limits(), options_, view.size);
  if (froxels_.extent() != count) {
    try {
      froxels_ = gpu::Texture::volume(gpu::Format::rgba32f, count);
    } catch (const scene::Error&) {
      throw too_many(options_, count, "this driver has memory for");
    }
    froxels_.sample_linearly();
  }
  const gpu::Texture& shadow_map = inputs.shadow_map(0.0);
  const gpu::Texture* light_texture = inputs.light_texture();
  const Programs& programs = load({.phase = static_cast<std::uint32_t>(view.medium.phase),
                                   .layer = layer_of(view.medium, light, view.camera.eye),
                                   .reach = reach_of(light),
                                   .light_textured = light_texture != nullptr,
                                   .plane = inputs.shadow_map_is_plane(),
                                   .sun = scene::is_sun(light),
                                   .history = options_.history});
  const auto farthest = static_cast<float>(farthest_slice(view, light, inputs.scene.box()));
  const glm::uvec3 counts(std::bit_cast<std::uint32_t>(farthest), options_.slices, options_.samples);
  for (const gpu::Pipeline* program : {&programs.scatter, &programs.sum, &programs.read.pipeline()})
    program->set(0, counts);
  const shaders::EpipolarBlock block = gridless_space(view, light);
  space_.write(&block, sizeof block);
  space_.bind_uniform(shaders::k_space_block);
  shadow_map.bind_sampler(shaders::k_shadow_map_unit);
  if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
  froxels_.bind_image(shaders::k_froxels_image);
  if (options_.history) begin_history(inputs, count, farthest);
  inputs.timer.time("populate", [&] { programs.scatter.dispatch(glm::uvec3(count)); });
  inputs.timer.time("integrate", [&] {
    programs.sum.dispatch({count.x, count.y, 1});
    inputs.surfaces.bind_sampler(shaders::k_surface_unit);
    froxels_.bind_sampler(shaders::k_scratch_unit);
    programs.read.run({radiance});
  });
}

std::map<std::string, double> Froxel::counters(const frame::FrameInputs&) {
  const glm::dvec3 count(froxels_.extent());
  return {{"look_ups", options_.samples * count.x * count.y * count.z}};
}

std::map<std::string, std::int64_t> Froxel::bytes() const {
  std::map<std::string, std::int64_t> bytes = {{"froxels", froxels_.bytes()}};
  if (options_.history) {
    bytes["history"] = lit_.bytes();
    for (const History& history : histories_) bytes["history"] += history.lit.bytes();
  }
  return bytes;
}

frame::AirlightMethod froxel_method() {
  return frame::describe<frame::Airlight, FroxelOptions>(
      "froxel", "a volume of the view frustum, lit from the shadow map", {},
      {frame::count_option({.name = "tile",
                            .meaning = "side of a froxel in the image, in pixels",
                            .quality = "large ones blur shafts and leak at silhouettes",
                            .cost = "memory, populate and integrate by its square",
                            .sweep = {"2", "4", "8", "16"}},
                           frame::Counts{.most = 64}, &FroxelOptions::tile),
       frame::count_option({.name = "slices",
                            .meaning = "froxels in depth, thicker away from the eye",
                            .quality = "too few show as bands across shafts",
                            .cost = "memory, populate, integrate",
                            .sweep = {"32", "64", "128", "256"}},
                           frame::Counts{.least = 8, .most = 512}, &FroxelOptions::slices),
       frame::count_option({.name = "samples",
                            .meaning = "look-ups of the shadow map a froxel, the first in its middle",
                            .quality = "one leaves stairs at edges of shafts",
                            .cost = "populate",
                            .sweep = {"1", "4", "16"}},
                           frame::Counts{.most = 64}, &FroxelOptions::samples),
       frame::word_option(
           {.name = "history",
            .meaning = "along a path, whether what is lit is blended with what the frame before found",
            .quality = "on averages look-ups of some twenty frames; what moves leaves ghosts",
            .cost = "on takes a look-up in the frame before, and a quarter more memory, twice"},
           {{"off", "each frame stands for itself"},
            {"on", "19 parts of 20 are from before, where that was seen"}},
           &FroxelOptions::history)},
      [](const gpu::Context&, const FroxelOptions& options) { return std::make_unique<Froxel>(options); });
}

}  // namespace airlight::media
