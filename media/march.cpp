#include "media/march.h"

#include <bit>
#include <cassert>
#include <span>
#include <vector>

#include "spirv/media/march_frag.h"
#include "spirv/media/march_gather_frag.h"
#include "spirv/media/march_rows_frag.h"

namespace airlight::media {
March::March(const gpu::Context& context, const MarchOptions& options)
    : options_(options), space_(sizeof(shaders::EpipolarBlock)) {
  if (options.look_up == MarchLookUp::rows) rows_.emplace(context.limits(), options.volume);
  if (options.jitter == MarchJitter::gathered) gather_.emplace(k_march_gather_frag);
}

const frame::ScreenPass& March::load(const Variant& variant) {
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
  } else {
    constants.emplace_back(16, variant.plane);
  }
  const std::span<const std::uint32_t> fragment =
      rows_ ? std::span<const std::uint32_t>(k_march_rows_frag) : k_march_frag;
  return passes_.emplace(variant, frame::ray_pass(options_.rays, fragment, constants)).first->second;
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
  const frame::ScreenPass& pass = load({.phase = static_cast<std::uint32_t>(view.medium.phase),
                                        .layer = layer,
                                        .reach = reach_of(light),
                                        .light_textured = light_texture != nullptr,
                                        .plane = inputs.shadow_map_is_plane(),
                                        .rough = !is_sun && is_rough(inputs, layer),
                                        .sun = is_sun});
  const scene::Box& box = inputs.scene.box();
  const double reach = !box.empty() ? scene::reach_from(view.camera.eye, box)
                       : is_sun     ? 1.0
                                    : glm::distance(view.camera.eye, light.position);
  pass.pipeline().set(0, glm::uvec2(static_cast<std::uint32_t>(options_.steps),
                                    std::bit_cast<std::uint32_t>(static_cast<float>(reach))));
  if (rows_) {
    rows_->find_ranges(inputs);
    rows_->fill(inputs);
  } else {
    const shaders::EpipolarBlock block = gridless_space(view, light);
    space_.write(&block, sizeof block);
    space_.bind_uniform(shaders::k_space_block);
    inputs.shadow_map(0.0).bind_sampler(shaders::k_shadow_map_unit);
  }
  if (gather_ && scattered_.size() != radiance.size())
    scattered_ = gpu::Texture(radiance.format(), radiance.size());
  inputs.timer.time("integrate", [&] {
    inputs.ray_surfaces().bind_sampler(shaders::k_surface_unit);
    if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
    pass.run({gather_ ? scattered_ : radiance});
    if (!gather_) return;
    scattered_.bind_sampler(shaders::k_scratch_unit);
    gather_->run({radiance});
  });
}

std::map<std::string, std::int64_t> March::bytes() const {
  std::map<std::string, std::int64_t> bytes;
  if (rows_) bytes = rows_->bytes();
  if (gather_) bytes["scattered"] = scattered_.bytes();
  return bytes;
}

std::map<std::string, double> March::counters(const frame::FrameInputs& inputs) {
  return {{"look_ups", options_.steps * inputs.ray_count()}};
}

frame::AirlightMethod march_method() {
  std::vector<frame::Option> options = {
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
          &MarchOptions::jitter),
      frame::word_option(
          {.name = "look-up",
           .meaning = "what is looked up",
           .quality = "rows are as exact as their light rays are dense",
           .cost = "rows are made once, and neighbours in them are neighbours in memory",
           .sweep = {"map", "rows"}},
          {{"map", "the shadow map"},
           {"rows", "light rays of each half-plane, resampled from it: theta half-planes, phi rays"}},
          &MarchOptions::look_up)};
  for (frame::Option& option : frame::options_of(&MarchOptions::volume, epipolar::volume_options())) {
    if (option.text.name != "theta" && option.text.name != "phi") continue;
    option.text.is_common = false;  // of rows alone
    options.push_back(std::move(option));
  }
  for (frame::Option& option : frame::options_of(&MarchOptions::rays, frame::view_rays_options()))
    options.push_back(std::move(option));
  return frame::describe<frame::Airlight, MarchOptions>(
      "march", "look-ups of the shadow map, or of its rows, along each view ray", {}, std::move(options),
      [](const gpu::Context& context, const MarchOptions& march) {
        return std::make_unique<March>(context, march);
      });
}

}  // namespace airlight::media
