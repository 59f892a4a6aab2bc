#include "media/march.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <span>
#include <utility>
#include <vector>

#include "surface_shadows/metric_tree.h"
#include "surface_shadows/psv.h"

#include "spirv/media/march_frag.h"
#include "spirv/media/march_gather_frag.h"
#include "spirv/media/march_rows_frag.h"
#include "spirv/media/tree_march_metric_tree_frag.h"
#include "spirv/media/tree_march_psv_frag.h"

namespace airlight::media {

/// Drivers end a shader's loops unasked after 65,535 turns of all of them (llvmpipe), or when it takes too
/// long (a GPU that also drives a display): a way down a tree takes up to some thousand.
constexpr std::uint32_t k_steps_of_tree_pass = 16;

namespace {

std::unique_ptr<surface_shadows::ShadowTree> make_tree(MarchTree tree) {
  if (tree == MarchTree::psv) return std::make_unique<surface_shadows::Psv>(surface_shadows::PsvOptions{});
  return std::make_unique<surface_shadows::MetricTree>(surface_shadows::MetricTreeOptions{});
}

std::span<const std::uint32_t> fragment_of(const MarchOptions& options) {
  switch (options.look_up) {
    case MarchLookUp::map:
      return k_march_frag;
    case MarchLookUp::rows:
      return k_march_rows_frag;
    case MarchLookUp::tree:
      break;
  }
  if (options.tree == MarchTree::psv) return k_tree_march_psv_frag;
  return k_tree_march_metric_tree_frag;
}

}  // namespace

March::March(const gpu::Context& context, const MarchOptions& options)
    : options_(options), space_(sizeof(shaders::EpipolarBlock)) {
  if (options.look_up == MarchLookUp::tree) tree_ = make_tree(options.tree);
  if (options.look_up == MarchLookUp::rows) rows_.emplace(context.limits(), options.volume);
  if (options.jitter == MarchJitter::gathered) gather_.emplace(k_march_gather_frag);
}

const frame::ScreenPass& March::load(const Variant& variant, const frame::SceneBuffers& scene) {
  if (const auto found = passes_.find(variant); found != passes_.end()) return found->second;
  const bool by_angle = options_.spacing == MarchSpacing::angle;
  const auto jitter = static_cast<std::uint32_t>(options_.jitter);
  std::vector<gpu::Constant> constants = {gpu::Constant(3, variant.phase),
                                          gpu::Constant(9, variant.rough),
                                          gpu::Constant(10, variant.layer),
                                          gpu::Constant(12, variant.reach),
                                          gpu::Constant(13, variant.light_textured),
                                          gpu::Constant(18, variant.sun),
                                          gpu::Constant(19, by_angle),
                                          gpu::Constant(20, jitter)};
  if (rows_) {
    for (const gpu::Constant& count : epipolar::resolution_constants(rows_->grid().resolution()))
      constants.push_back(count);
    constants.emplace_back(11, true);  // some view rays may look away from the light
    constants.emplace_back(17, static_cast<std::uint32_t>(epipolar::Query::light_rays));
  } else if (tree_) {
    for (const gpu::Constant& constant : tree_->walk_constants(scene)) constants.push_back(constant);
  } else {
    constants.emplace_back(16, variant.plane);
  }
  return passes_
      .emplace(variant, frame::ray_pass(options_.rays, fragment_of(options_), constants,
                                        variant.adds ? gpu::Blend::add : gpu::Blend::replace))
      .first->second;
}

std::optional<frame::Refusal> MarchOptions::refusal(const scene::View& view) const {
  if (auto narrow = narrow_lobe(view.medium)) return narrow;
  if (jitter == MarchJitter::gathered && rays.are_listed())
    return frame::Refusal{"jitter=gathered", "it cannot gather neighbours of rays on epipolar lines",
                          "use jitter=interleaved or off, or another where than epipolar"};
  return {};
}

void March::integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) {
  assert(!options_.refusal(inputs.view) && options_.rays.are_listed() == inputs.listed.has_value());
  const scene::View& view = inputs.view;
  const scene::Light& light = inputs.light();
  const gpu::Texture* light_texture = inputs.light_texture();
  const bool is_sun = scene::is_sun(light);
  const std::uint32_t layer = layer_of(view.medium, light, view.camera.eye);
  const auto steps = static_cast<std::uint32_t>(options_.steps);
  const std::uint32_t steps_of_pass = tree_ ? k_steps_of_tree_pass : steps;
  Variant variant{.phase = static_cast<std::uint32_t>(view.medium.phase),
                  .layer = layer,
                  .reach = reach_of(light),
                  .light_textured = light_texture != nullptr,
                  .plane = inputs.shadow_map_is_plane(),
                  .rough = !is_sun && is_rough(inputs, layer),
                  .sun = is_sun,
                  .transmits = tree_ && inputs.scene.transmits(),
                  .adds = false};
  std::vector<const frame::ScreenPass*> passes;
  for (std::uint32_t from = 0; from < steps; from += steps_of_pass) {
    variant.adds = from > 0;
    passes.push_back(&load(variant, inputs.scene));
  }
  const scene::Box& box = inputs.scene.box();
  const double reach = !box.empty() ? scene::reach_from(view.camera.eye, box)
                       : is_sun     ? 1.0
                                    : glm::distance(view.camera.eye, light.position);
  if (rows_) {
    rows_->find_ranges(inputs);
    rows_->fill(inputs);
  } else {
    const shaders::EpipolarBlock block = gridless_space(view, light);
    space_.write(&block, sizeof block);
    space_.bind_uniform(shaders::k_space_block);
    if (tree_) {
      tree_->build(inputs);
      for (const frame::ScreenPass* pass : passes) tree_->bind_walk(inputs, pass->pipeline());
    } else {
      inputs.shadow_map(0.0).bind_sampler(shaders::k_shadow_map_unit);
    }
  }
  if (gather_ && scattered_.size() != radiance.size())
    scattered_ = gpu::Texture(radiance.format(), radiance.size());
  inputs.timer.time("integrate", [&] {
    inputs.ray_surfaces().bind_sampler(shaders::k_surface_unit);
    if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
    for (std::uint32_t i = 0; i < passes.size(); ++i) {
      passes[i]->pipeline().set(0, glm::uvec4(steps, std::bit_cast<std::uint32_t>(static_cast<float>(reach)),
                                              i * steps_of_pass, std::min(steps, (i + 1) * steps_of_pass)));
      passes[i]->run({gather_ ? scattered_ : radiance});
    }
    if (!gather_) return;
    scattered_.bind_sampler(shaders::k_scratch_unit);
    gather_->run({radiance});
  });
}

std::map<std::string, std::int64_t> March::bytes() const {
  std::map<std::string, std::int64_t> bytes;
  if (rows_) bytes = rows_->bytes();
  if (tree_) bytes = tree_->bytes();
  if (gather_) bytes["scattered"] = scattered_.bytes();
  return bytes;
}

std::map<std::string, double> March::counters(const frame::FrameInputs& inputs) {
  return {{"look_ups", options_.steps * inputs.ray_count()}};
}

namespace {

/// How view rays are cut into steps, and where in these points are looked up.
std::vector<frame::Option> step_options() {
  return {
      frame::count_option({.name = "steps",
                           .meaning = "look-ups a view ray",
                           .quality = "too few show as bands across shafts",
                           .cost = "integrate",
                           .sweep = {"8", "16", "32", "64", "128", "256", "512"}},
                          frame::Counts{.least = 8, .most = 512}, &MarchOptions::steps),
      frame::word_option(
          {.name = "spacing",
           .meaning = "how a lamp's view rays are cut into steps; a sun's are by distance",
           .quality = "angle follows the light near the lamp, distance shadows far from it",
           .cost = "none",
           .sweep = {"distance", "angle"}},
          {{"distance", "equal in the distance from the eye"}, {"angle", "equal in the angle at the light"}},
          &MarchOptions::spacing),
      frame::word_option(
          {.name = "jitter",
           .meaning = "where in its step a look-up lies",
           .quality = "interleaved turns bands into a pattern of 4 x 4 pixels, gathered softens both",
           .cost = "gathered takes a pass over the image",
           .sweep = {"off", "interleaved", "gathered"}},
          {{"off", "in the middle"},
           {"interleaved", "elsewhere for each of 4 x 4 pixels"},
           {"gathered", "so, and then the mean of such pixels of one surface"}},
          &MarchOptions::jitter)};
}

frame::AirlightMethod method_of(std::string_view name, std::string_view description,
                                const frame::Traits& traits, std::vector<frame::Option> options,
                                const MarchOptions& defaults) {
  for (frame::Option& option : frame::options_of(&MarchOptions::rays, frame::view_rays_options()))
    options.push_back(std::move(option));
  frame::AirlightMethod method = frame::describe<frame::Airlight, MarchOptions>(
      name, description, traits, std::move(options),
      [](const gpu::Context& context, const MarchOptions& march) {
        return std::make_unique<March>(context, march);
      });
  method.defaults = defaults;
  return method;
}

}  // namespace

frame::AirlightMethod march_method() {
  std::vector<frame::Option> options = step_options();
  options.push_back(frame::word_option(
      {.name = "look-up",
       .meaning = "what is looked up",
       .quality = "rows are as exact as their light rays are dense",
       .cost = "rows are made once, and neighbours in them are neighbours in memory",
       .sweep = {"map", "rows"}},
      {{"map", "the shadow map"},
       {"rows", "light rays of each half-plane, resampled from it: theta half-planes, phi rays"}},
      &MarchOptions::look_up));
  for (frame::Option& option : frame::options_of(&MarchOptions::volume, epipolar::volume_options())) {
    if (option.text.name != "theta" && option.text.name != "phi") continue;
    option.text.is_common = false;  // of rows alone
    options.push_back(std::move(option));
  }
  return method_of("march", "look-ups of the shadow map, or of its rows, along each view ray", {},
                   std::move(options), {});
}

frame::AirlightMethod tree_march_method() {
  std::vector<frame::Option> options = step_options();
  options.push_back(frame::word_option(
      {.name = "tree",
       .meaning = "which tree is asked",
       .quality = "none",
       .cost = "a tree is made each frame, and asked at every step",
       .sweep = {"psv", "metric-tree"}},
      {{"psv", "partitioned shadow volumes"}, {"metric-tree", "clusters of triangles in a metric tree"}},
      &MarchOptions::tree));
  return method_of("tree-march", "a tree of triangles asked along each view ray: no voxels, no shadow map",
                   {.transmits = true}, std::move(options), {.look_up = MarchLookUp::tree});
}

}  // namespace airlight::media
