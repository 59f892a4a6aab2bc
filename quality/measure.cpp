#include "quality/measure.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include <fmt/format.h>

#include "frame/none.h"

namespace airlight::quality {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int k_staged_frames = 3;        ///< frames with timed stages; enough for a median
constexpr double k_slow_frame_ms = 2000;  ///< a frame slower than this is timed once

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// The median time of each stage.
/// @param of_frame the times of a frame's stages, by name
template <typename Frames, typename Stages>
std::map<std::string, double> median_stages(const Frames& frames, const Stages& of_frame) {
  // What is made once for a scene is a stage of one frame alone.
  std::map<std::string, std::vector<double>> times;
  for (const auto& frame : frames)
    for (const auto& [stage, ms] : of_frame(frame)) times[stage].push_back(ms);
  std::map<std::string, double> medians;
  for (const auto& [stage, times_of_stage] : times) medians[stage] = median(times_of_stage);
  return medians;
}

/// Looks at what an airlight method left behind of each light.
class DebugProbe : public frame::Airlight {
 public:
  explicit DebugProbe(frame::Airlight& airlight) : airlight_(airlight) {}
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    airlight_.integrate(inputs, radiance);
    for (frame::DebugImage& image : airlight_.debug_images(inputs)) {
      if (inputs.view.lights.size() > 1) {
        image.name += fmt::format("_{}", inputs.light_index);
        image.caption += fmt::format(", of light '{}'", inputs.light().name);
      }
      images_.push_back(std::move(image));
    }
  }
  std::vector<frame::DebugImage> take_images() { return std::move(images_); }

 private:
  frame::Airlight& airlight_;
  std::vector<frame::DebugImage> images_;
};

}  // namespace

Measurer::Measurer(gpu::Context& context, const scene::Geometry& geometry, const scene::View& view,
                   int shadow_map_size, Progress progress, const std::filesystem::path& cache)
    : context_(context),
      view_(view),
      progress_(progress),
      frame_(context, geometry, shadow_map_size),
      reference_(geometry, view, std::move(progress), cache) {}

void Measurer::draw(frame::SurfaceShadow& shadow, frame::Airlight& airlight) {
  gpu::StageTimer off(nullptr);
  frame_.render(view_, shadow, airlight, off);
}

void Measurer::try_out(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces) {
  frame::NoShadow no_shadow;
  frame::NoAirlight no_airlight;
  draw(no_shadow, no_airlight);
  for (const VolumeChoice& choice : volumes)
    if (choice.method->traits.runs_on_gpu) draw(no_shadow, *choice.make(context_, reference_));
  for (const SurfaceChoice& choice : surfaces)
    if (choice.method->traits.runs_on_gpu) draw(*choice.make(context_, reference_), no_airlight);
  context_.finish();
}

frame::FrameImages Measurer::render(const VolumeChoice& volume, const SurfaceChoice& surface) {
  const auto airlight = volume.make(context_, reference_);
  const auto shadow = surface.make(context_, reference_);
  draw(*shadow, *airlight);
  return frame_.read();
}

struct Measurer::TimedFrame {
  double ms;
  std::map<std::string, double> stages_ms;                     ///< empty unless timed
  std::vector<std::map<std::string, double>> light_stages_ms;  ///< the same, for each light
  SharedReference::Work work;
};

Measurer::TimedFrame Measurer::render_timed(frame::SurfaceShadow& shadow, frame::Airlight& airlight,
                                            bool with_stages) {
  gpu::StageTimer timer(with_stages ? &context_ : nullptr);
  reference_.take_work();
  context_.finish();
  const Clock::time_point start = Clock::now();
  frame_.render(view_, shadow, airlight, timer);
  context_.finish();
  TimedFrame timed{milliseconds_since(start), timer.milliseconds(), {}, reference_.take_work()};
  for (std::size_t light = 0; light < view_.lights.size(); ++light)
    timed.light_stages_ms.push_back(timer.milliseconds(light));
  // An image that was kept costs what it cost when it was traced.
  timed.ms += timed.work.kept_airlight_ms + timed.work.kept_surface_ms;
  if (!with_stages) return timed;
  for (const auto& [light, stages] : timed.work.kept_stages_ms) {
    for (const auto& [stage, ms] : stages) {
      timed.stages_ms[stage] += ms;
      timed.light_stages_ms[light][stage] += ms;
    }
  }
  return timed;
}

Measurer::Measurement Measurer::measure(const VolumeChoice& volume, const SurfaceChoice& surface,
                                        int frames) {
  const auto airlight = volume.make(context_, reference_);
  const auto shadow = surface.make(context_, reference_);
  const auto progress = [&](double fraction) {
    if (progress_) progress_(fmt::format("{} × {}", volume.spec, surface.spec), fraction);
  };

  // Frames with timed stages, then whole ones.
  progress(0.0);
  std::vector<TimedFrame> staged = {render_timed(*shadow, *airlight, true)};
  std::vector<double> times = {staged[0].ms}, tracing = {staged[0].work.airlight_ms};
  if (staged[0].ms <= k_slow_frame_ms) {
    staged.clear();  // that one was the warm-up
    times.clear();
    tracing.clear();
    while (staged.size() < k_staged_frames) staged.push_back(render_timed(*shadow, *airlight, true));
    for (int i = 0; i < frames; ++i) {
      const TimedFrame timed = render_timed(*shadow, *airlight, false);
      times.push_back(timed.ms);
      tracing.push_back(timed.work.airlight_ms);
      progress(static_cast<double>(i + 1) / frames);
    }
  }

  Measurement measurement;
  Cost& cost = measurement.cost;
  measurement.images = frame_.read();
  cost.stages_ms = median_stages(
      staged, [](const TimedFrame& timed) -> const auto& { return timed.stages_ms; });
  for (std::size_t light = 0; light < view_.lights.size(); ++light)
    cost.lights.push_back(
        {measurement.images.is_skipped[light],
         median_stages(
             staged, [&](const TimedFrame& timed) -> const auto& { return timed.light_stages_ms[light]; })});
  cost.frame_ms = median(times);
  cost.frames = static_cast<int>(times.size());
  cost.rays = staged[0].work.airlight_rays;
  cost.self_error = staged[0].work.self_error;
  if (cost.rays > 0) cost.mrays_per_s = static_cast<double>(cost.rays) / (1e3 * median(tracing));
  cost.bytes = frame_.bytes();
  for (const auto& [name, bytes] : airlight->bytes()) cost.bytes[name] += bytes;
  for (const auto& [name, bytes] : shadow->bytes()) cost.bytes[name] += bytes;
  return measurement;
}

std::vector<frame::DebugImage> Measurer::debug_images(const VolumeChoice& volume) {
  const auto airlight = volume.make(context_, reference_);
  DebugProbe probe(*airlight);
  frame::NoShadow no_shadow;
  draw(no_shadow, probe);
  return probe.take_images();
}

}  // namespace airlight::quality
