#include "viewer/ladder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "frame/none.h"
#include "frame/option.h"
#include "frame/point_reader.h"
#include "quality/probes.h"

namespace airlight::viewer {
namespace {

/// Kept of each rung: what is automatic takes one of two values.
constexpr std::size_t k_kept_methods = 2;

/// A count of a method's cells made smaller, as far as the option allows.
template <typename MethodType>
void shrink(quality::Choice<MethodType>& choice, double part) {
  for (const char* name : {"alpha", "theta", "phi"}) {
    const frame::Option* option = choice.method->find(name);
    if (!option) continue;
    const auto* counts = std::get_if<frame::Counts>(&option->values);
    const frame::OptionValue value = option->get(choice.method->const_address(choice.options));
    if (!counts || !std::holds_alternative<int>(value)) continue;
    const int step = counts->multiple_of;
    const int count = static_cast<int>(std::round(std::get<int>(value) * part / step)) * step;
    // A count that an option derives from another cannot be set, and stays.
    option->set(choice.method->address(choice.options), name,
                fmt::format("{}", std::clamp(count, std::max(counts->least, step), std::get<int>(value))));
  }
}

}  // namespace

Ladder::Ladder(gpu::Context& context, const scene::Geometry& geometry,
               std::shared_ptr<const frame::SceneBuffers> scene)
    : context_(context), geometry_(geometry), scene_(std::move(scene)) {}

void Ladder::show(const Shown& shown) {
  const bool is_other = !shown_ || shown_->volume.words() != shown.volume.words() ||
                        shown_->surface.words() != shown.surface.words() ||
                        shown_->shadow_map != shown.shadow_map || shown_->view.size != shown.view.size;
  shown_ = shown;
  if (is_other) clear();
}

void Ladder::clear() {
  for (OfRung& rung : of_rung_) rung.reset();
}

glm::ivec2 Ladder::size(std::size_t rung) const {
  const glm::dvec2 size = k_rungs[rung].image * glm::dvec2(shown_->view.size);
  return glm::max(glm::ivec2(glm::round(size)), glm::ivec2(1));
}

Shown Ladder::shown(std::size_t rung) const {
  Shown shown = *shown_;
  shown.view.size = size(rung);
  shown.shadow_map = std::max(static_cast<int>(std::lround(k_rungs[rung].shadow_map * shown.shadow_map)), 1);
  shown.volume.fit(shown.view);
  shown.surface.fit(shown.view);
  if (rung > 0) {
    shrink(shown.volume, k_rungs[rung].cells);
    shrink(shown.surface, k_rungs[rung].cells);
  }
  return shown;
}

const frame::Frame& Ladder::draw(std::size_t rung, gpu::StageTimer& timer, frame::Resting resting) {
  const Shown drawn = shown(rung);
  OfRung& of_rung = of_rung_[rung];
  if (!of_rung.frame) of_rung.frame.emplace(context_, geometry_, drawn.shadow_map, scene_);
  const std::string words = drawn.volume.words() + drawn.surface.words();
  auto made = of_rung.methods.find(words);
  const bool compiles = made == of_rung.methods.end();
  if (compiles) {
    if (of_rung.methods.size() == k_kept_methods) of_rung.methods.clear();
    Made methods{drawn.volume.method->make(context_, drawn.volume.options),
                 drawn.surface.method->make(context_, drawn.surface.options)};
    made = of_rung.methods.emplace(words, std::move(methods)).first;
  }
  of_rung.made = &made->second;
  const auto start = std::chrono::steady_clock::now();
  of_rung.frame->render(drawn.view, *of_rung.made->surface, *of_rung.made->airlight, timer, resting);
  context_.finish();
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (!compiles) ++of_rung.frames;
  of_rung.ms = ms;
  return *of_rung.frame;
}

template <typename Look>
void Ladder::look_into(std::size_t rung, const Look& look) {
  const Shown drawn = shown(rung);
  OfRung& of_rung = of_rung_[rung];
  gpu::StageTimer off(nullptr);
  look(*of_rung.made, [&](frame::SurfaceShadow& surface, frame::Airlight& airlight) {
    of_rung.frame->render(drawn.view, surface, airlight, off);
  });
  // It may have cost the methods what they had, and the frame its image.
  of_rung.frame->render(drawn.view, *of_rung.made->surface, *of_rung.made->airlight, off);
  context_.finish();
}

std::vector<frame::DebugImage> Ladder::inspect(std::size_t rung) {
  std::vector<frame::DebugImage> images;
  look_into(rung, [&](const Made& made, const auto& render) {
    quality::AirlightProbe probe(*made.airlight, [&](const frame::FrameInputs& inputs) {
      std::vector<frame::DebugImage> of_light = made.airlight->debug_images(inputs);
      if (inputs.light_index == 0) images = std::move(of_light);  // one light's are enough to look at
    });
    render(*made.surface, probe);
  });
  return images;
}

frame::SurfacePoints Ladder::surface_points(std::size_t rung) {
  frame::PointReader reader;
  look_into(rung, [&](const Made&, const auto& render) {
    frame::NoAirlight no_airlight;
    render(reader, no_airlight);
  });
  return reader.take_points();
}

std::optional<double> Ladder::ms(std::size_t rung) const {
  return of_rung_[rung].frames > 0 ? of_rung_[rung].ms : std::nullopt;
}

std::int64_t Ladder::bytes(std::size_t rung) const {
  const OfRung& of_rung = of_rung_[rung];
  if (!of_rung.frame || !of_rung.made) return 0;
  std::int64_t sum = 0;
  for (const auto& [name, bytes] : of_rung.frame->bytes()) sum += name == "scene" ? 0 : bytes;
  for (const auto& [name, bytes] : of_rung.made->airlight->bytes()) sum += bytes;
  for (const auto& [name, bytes] : of_rung.made->surface->bytes()) sum += bytes;
  return sum;
}

}  // namespace airlight::viewer
