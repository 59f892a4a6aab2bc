#include "quality/measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frame/none.h"
#include "frame/point_reader.h"
#include "quality/probes.h"
#include "quality/statistics.h"

namespace airlight::quality {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int k_staged_frames = 3;    ///< frames with timed stages; enough for a median
constexpr double k_warm_up_ms = 300;  ///< of frames, in which a GPU's clock rises

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Time that all of the process's threads have spent on CPUs.
double cpu_milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
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

}  // namespace

Measurer::Measurer(gpu::Context& context, const scene::Geometry& geometry, const scene::View& view,
                   int shadow_map_size, Progress progress, const std::filesystem::path& cache)
    : context_(context),
      geometry_(geometry),
      view_(&view),
      progress_(std::move(progress)),
      cache_(cache),
      frame_(context, geometry, shadow_map_size, {}, {cache, progress_}) {
  look_at(view);
}

void Measurer::look_at(const scene::View& view) {
  view_ = &view;
  reference_.emplace(geometry_, view, progress_, cache_);
}

void Measurer::draw(frame::SurfaceShadow& shadow, frame::Airlight& airlight) {
  gpu::StageTimer off(nullptr);
  frame_.render(*view_, shadow, airlight, off);
}

std::map<std::string, double> Measurer::count(frame::SurfaceShadow& shadow, frame::Airlight& airlight) {
  std::map<std::string, double> counters;
  const auto add = [&](const std::map<std::string, double>& counts) {
    for (const auto& [name, count] : counts) counters[name] += count;
  };
  ShadowProbe shadow_probe(shadow, [&](const frame::FrameInputs& inputs) { add(shadow.counters(inputs)); });
  AirlightProbe airlight_probe(airlight, [&](const frame::FrameInputs& inputs) {
    add(airlight.counters(inputs));
    counters["view_rays"] += inputs.ray_count();
  });
  draw(shadow_probe, airlight_probe);
  for (auto& [name, count] : counters) count /= static_cast<double>(view_->size.x) * view_->size.y;
  return counters;
}

void Measurer::try_out(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces) {
  frame::NoShadow no_shadow;
  frame::NoAirlight no_airlight;
  draw(no_shadow, no_airlight);
  for (const VolumeChoice& choice : volumes)
    if (choice.method->traits.runs_on_gpu) draw(no_shadow, *choice.make(context_, *reference_));
  for (const SurfaceChoice& choice : surfaces)
    if (choice.method->traits.runs_on_gpu) draw(*choice.make(context_, *reference_), no_airlight);
  context_.finish();
}

frame::FrameImages Measurer::render(const VolumeChoice& volume, const SurfaceChoice& surface) {
  const auto airlight = volume.make(context_, *reference_);
  const auto shadow = surface.make(context_, *reference_);
  draw(*shadow, *airlight);
  return frame_.read();
}

frame::SurfacePoints Measurer::surface_points() {
  frame::PointReader reader;
  frame::NoAirlight no_airlight;
  draw(reader, no_airlight);
  return reader.take_points();
}

struct Measurer::TimedFrame {
  double ms, cpu_ms;
  std::map<std::string, double> stages_ms;                     ///< empty unless timed
  std::vector<std::map<std::string, double>> light_stages_ms;  ///< the same, for each light
  SharedReference::Work work;
};

Measurer::TimedFrame Measurer::render_timed(frame::SurfaceShadow& shadow, frame::Airlight& airlight,
                                            bool with_stages, frame::Resting resting) {
  gpu::StageTimer timer(with_stages ? &context_ : nullptr);
  reference_->take_work();
  context_.finish();
  const double cpu_start = cpu_milliseconds();
  const Clock::time_point start = Clock::now();
  frame_.render(*view_, shadow, airlight, timer, resting);
  context_.finish();
  TimedFrame timed{milliseconds_since(start),
                   cpu_milliseconds() - cpu_start,
                   timer.milliseconds(),
                   {},
                   reference_->take_work()};
  if (!timed.work.kept_ms.empty()) timed.cpu_ms = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t light = 0; light < view_->lights.size(); ++light)
    timed.light_stages_ms.push_back(timer.milliseconds(light));
  // An image that was kept costs what it cost when it was traced.
  for (const auto& [light, stages] : timed.work.kept_ms) {
    for (const auto& [stage, ms] : stages) {
      timed.ms += ms;
      if (!with_stages) continue;
      timed.stages_ms[stage] += ms;
      timed.light_stages_ms[light][stage] += ms;
    }
  }
  return timed;
}

Measurer::TimedFrame Measurer::render_timed(std::span<const scene::View> views, std::size_t index,
                                            frame::SurfaceShadow& shadow, frame::Airlight& airlight,
                                            bool with_stages) {
  if (view_ != &views[index]) look_at(views[index]);
  lend(*reference_, airlight);
  lend(*reference_, shadow);
  return render_timed(shadow, airlight, with_stages,
                      index == 0 ? frame::Resting::redrawn : frame::Resting::kept);
}

void Measurer::warm_up(frame::SurfaceShadow& shadow, frame::Airlight& airlight) {
  if (context_.device().is_software) return;
  const Clock::time_point start = Clock::now();
  while (milliseconds_since(start) < k_warm_up_ms) render_timed(shadow, airlight, false);
}

std::map<std::string, std::int64_t> Measurer::bytes_of(const frame::SurfaceShadow& shadow,
                                                       const frame::Airlight& airlight) const {
  std::map<std::string, std::int64_t> all = frame_.bytes();
  for (const auto& [name, bytes] : airlight.bytes()) all[name] += bytes;
  for (const auto& [name, bytes] : shadow.bytes()) all[name] += bytes;
  return all;
}

Measurer::Measurement Measurer::measure(const VolumeChoice& volume, const SurfaceChoice& surface,
                                        int frames) {
  const auto airlight = volume.make(context_, *reference_);
  const auto shadow = surface.make(context_, *reference_);
  const auto progress = [&](double fraction) {
    if (progress_) progress_(fmt::format("{} × {}", volume.spec, surface.spec), fraction);
  };

  // Frames with timed stages, then whole ones.
  progress(0.0);
  std::vector<TimedFrame> staged = {render_timed(*shadow, *airlight, true)};
  std::vector<double> times = {staged[0].ms}, cpu_times = {staged[0].cpu_ms},
                      tracing = {staged[0].work.airlight_ms};
  if (staged[0].ms <= k_slow_frame_ms) {
    staged.clear();  // that one was part of the warm-up
    times.clear();
    cpu_times.clear();
    tracing.clear();
    warm_up(*shadow, *airlight);
    while (staged.size() < k_staged_frames) staged.push_back(render_timed(*shadow, *airlight, true));
    for (int i = 0; i < frames; ++i) {
      const TimedFrame timed = render_timed(*shadow, *airlight, false);
      times.push_back(timed.ms);
      cpu_times.push_back(timed.cpu_ms);
      tracing.push_back(timed.work.airlight_ms);
      progress(static_cast<double>(i + 1) / frames);
    }
  }

  Measurement measurement;
  Cost& cost = measurement.cost;
  measurement.images = frame_.read();
  cost.stages_ms = median_stages(
      staged, [](const TimedFrame& timed) -> const auto& { return timed.stages_ms; });
  for (std::size_t light = 0; light < view_->lights.size(); ++light)
    cost.lights.push_back(
        {measurement.images.is_skipped[light],
         median_stages(
             staged, [&](const TimedFrame& timed) -> const auto& { return timed.light_stages_ms[light]; })});
  cost.frame_ms = median(times);
  cost.cpu_ms = median(cpu_times);
  cost.frames = static_cast<int>(times.size());
  cost.rays = staged[0].work.airlight_rays;
  cost.self_error = staged[0].work.self_error;
  if (cost.rays > 0) cost.mrays_per_s = static_cast<double>(cost.rays) / (1e3 * median(tracing));
  cost.bytes = bytes_of(*shadow, *airlight);
  if (volume.method->traits.runs_on_gpu && surface.method->traits.runs_on_gpu)
    cost.counters = count(*shadow, *airlight);
  return measurement;
}

Measurer::PathMeasurement Measurer::measure_path(
    const VolumeChoice& volume, const SurfaceChoice& surface, std::span<const scene::View> views, int plays,
    const std::function<void(std::size_t, const frame::FrameImages&)>& look) {
  const auto airlight = volume.method->make(context_, volume.options);
  const auto shadow = surface.method->make(context_, surface.options);
  PathMeasurement measurement;
  std::vector<FrameCost>& frames = measurement.frames;
  frames.resize(views.size());
  Cost& cost = measurement.cost;
  cost.lights.assign(views[0].lights.size(), {true, {}});
  std::vector<std::vector<std::map<std::string, double>>> light_stages_ms(views.size());
  std::vector<std::vector<double>> times(views.size()), cpu_times(views.size());

  // A play is the images, the stages or the times of all frames.
  double tracing_ms = 0.0;
  const auto play = [&](bool is_first, bool with_stages) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      const TimedFrame timed = render_timed(views, i, *shadow, *airlight, with_stages);
      times[i].push_back(timed.ms);
      cpu_times[i].push_back(timed.cpu_ms);
      if (with_stages) frames[i].stages_ms = timed.stages_ms;
      if (with_stages) light_stages_ms[i] = timed.light_stages_ms;
      if (is_first) {
        frames[i].redrawn = frame_.redrawn();
        cost.rays += timed.work.airlight_rays;
        cost.self_error = std::max(cost.self_error, timed.work.self_error);
        tracing_ms += timed.work.airlight_ms;
        for (const auto& [name, bytes] : bytes_of(*shadow, *airlight))
          cost.bytes[name] = std::max(cost.bytes[name], bytes);
        const frame::FrameImages images = frame_.read();
        for (std::size_t light = 0; light < cost.lights.size(); ++light)
          cost.lights[light].is_skipped = cost.lights[light].is_skipped && images.is_skipped[light];
        look(i, images);
      }
      if (progress_)
        progress_(fmt::format("{} × {}", volume.spec, surface.spec),
                  static_cast<double>(i + 1) / static_cast<double>(views.size()));
    }
  };
  const auto medians_of = [](const std::vector<std::vector<double>>& values) {
    std::vector<double> medians;
    for (const std::vector<double>& of_frame : values) medians.push_back(median(of_frame));
    return medians;
  };
  play(true, true);
  cost.frames = 1;
  if (median(medians_of(times)) <= k_slow_frame_ms) {
    warm_up(*shadow, *airlight);
    play(false, true);
    times.assign(views.size(), {});
    cpu_times.assign(views.size(), {});
    for (int i = 0; i < plays; ++i) play(false, false);
    cost.frames = plays;
  }

  const std::vector<double> medians = medians_of(times), cpu_medians = medians_of(cpu_times);
  const double count = static_cast<double>(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    frames[i].ms = medians[i];
    cost.frame_ms += medians[i] / count;
    cost.cpu_ms += cpu_medians[i] / count;
    for (const auto& [stage, ms] : frames[i].stages_ms) cost.stages_ms[stage] += ms / count;
    for (std::size_t light = 0; light < cost.lights.size(); ++light)
      for (const auto& [stage, ms] : light_stages_ms[i][light])
        cost.lights[light].stages_ms[stage] += ms / count;
  }
  if (cost.rays > 0) cost.mrays_per_s = static_cast<double>(cost.rays) / (1e3 * tracing_ms);
  cost.rays /= views.size();
  return measurement;
}

namespace {

std::int64_t sum_of(const std::map<std::string, std::int64_t>& parts) {
  std::int64_t sum = 0;
  for (const auto& [name, bytes] : parts) sum += bytes;
  return sum;
}

}  // namespace

std::int64_t Measurer::Pair::bytes() const {
  return sum_of(airlight->bytes()) + sum_of(shadow->bytes());
}

Measurer::Pair Measurer::make(const VolumeChoice& volume, const SurfaceChoice& surface) const {
  return {volume.method->make(context_, volume.options), surface.method->make(context_, surface.options)};
}

std::vector<Measurer::FrameTime> Measurer::play(const Pair& pair, std::span<const scene::View> views) {
  std::vector<FrameTime> times;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const TimedFrame timed = render_timed(views, i, *pair.shadow, *pair.airlight, false);
    times.push_back({timed.ms, timed.cpu_ms});
  }
  return times;
}

std::int64_t Measurer::shared_bytes() const {
  return sum_of(frame_.bytes());
}

std::vector<frame::DebugImage> Measurer::debug_images(const VolumeChoice& volume) {
  const auto airlight = volume.make(context_, *reference_);
  std::vector<frame::DebugImage> images;
  AirlightProbe probe(*airlight, [&](const frame::FrameInputs& inputs) {
    for (frame::DebugImage& image : airlight->debug_images(inputs)) {
      if (inputs.view.lights.size() > 1) {
        image.name += fmt::format("_{}", inputs.light_index);
        image.caption += fmt::format(", of light '{}'", inputs.light().name);
      }
      images.push_back(std::move(image));
    }
  });
  frame::NoShadow no_shadow;
  draw(no_shadow, probe);
  return images;
}

}  // namespace airlight::quality
