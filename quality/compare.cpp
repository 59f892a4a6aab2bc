#include "quality/compare.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <span>
#include <thread>

#include <fmt/format.h>

#include "frame/frame.h"
#include "quality/metrics.h"

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

std::span<const float> floats(const std::vector<glm::vec3>& image) {
  return {image.empty() ? nullptr : &image[0].x, 3 * image.size()};
}

/// A spec as a part of a file name: "vsv:integral=riemann" becomes "vsv_integral-riemann".
std::string file_stem(std::string spec) {
  for (char& c : spec) {
    if (c == ':') c = '_';
    if (c == '=') c = '-';
  }
  return spec;
}

/// Looks at what an airlight method left behind.
class DebugProbe : public frame::Airlight {
 public:
  explicit DebugProbe(frame::Airlight& airlight) : airlight_(airlight) {}
  bool needs_shadow_map() const override { return airlight_.needs_shadow_map(); }
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    airlight_.integrate(inputs, radiance);
    images_ = airlight_.debug_images(inputs);
  }
  const std::vector<frame::DebugImage>& images() const { return images_; }

 private:
  frame::Airlight& airlight_;
  std::vector<frame::DebugImage> images_;
};

/// Runs methods of one view in turn, over one copy of the scene on the GPU.
class Comparer {
 public:
  Comparer(gpu::Context& context, const CompareRequest& request)
      : context_(context),
        request_(request),
        frame_(context, request.scene.geometry, request.shadow_map_size),
        reference_(request.scene.geometry, request.view, request.progress) {}

  Comparison compare() {
    Comparison comparison;
    comparison.scene = request_.scene_name;
    comparison.triangles = request_.scene.geometry.triangles.size();
    comparison.report = request_.scene.report;
    comparison.view = request_.view;
    comparison.shadow_map_size = request_.shadow_map_size;
    comparison.device = context_.device();
    comparison.cores = std::max(1u, std::thread::hardware_concurrency());
    try_every_method();
    trace_truth(comparison);
    for (const VolumeChoice& volume : request_.volumes) {
      for (const SurfaceChoice& surface : request_.surfaces) {
        comparison.runs.push_back(run(volume, surface, comparison));
      }
    }

    double fastest_march_ms = 0.0;
    for (const Run& run : comparison.runs) {
      if (run.volume.substr(0, run.volume.find(':')) != "reference-march") continue;
      fastest_march_ms = fastest_march_ms > 0.0 ? std::min(fastest_march_ms, run.frame_ms) : run.frame_ms;
    }
    for (Run& run : comparison.runs) run.march_ratio = fastest_march_ms / run.frame_ms;
    return comparison;
  }

 private:
  /// Draws one frame with every method of the GPU, so that what the driver cannot do is known before the long
  /// work.
  void try_every_method() {
    frame::NoShadow no_shadow;
    frame::NoAirlight no_airlight;
    gpu::StageTimer off(nullptr);
    frame_.render(request_.view, no_shadow, no_airlight, off);
    for (const VolumeChoice& choice : request_.volumes) {
      if (!choice.method->is_judged) continue;
      const auto volume = choice.method->make(context_, reference_, choice.settings);
      frame_.render(request_.view, no_shadow, *volume, off);
    }
    for (const SurfaceChoice& choice : request_.surfaces) {
      if (!choice.method->is_judged) continue;
      const auto surface = choice.method->make(context_, reference_, choice.settings);
      frame_.render(request_.view, *surface, no_airlight, off);
    }
    context_.finish();
  }

  void trace_truth(Comparison& comparison) {
    const reference::AirlightImage& airlight = reference_.converged(request_.reference_samples);
    const reference::SurfaceImage& surfaces = reference_.surfaces();
    double sum = 0.0;
    for (float value : floats(airlight.radiance)) sum += static_cast<double>(value);
    comparison.truth = {.samples = request_.reference_samples,
                        .self_error = airlight.self_error,
                        .ms = airlight.ms,
                        .rays = airlight.rays,
                        .mean_airlight = sum / static_cast<double>(3 * airlight.radiance.size())};

    // The colour of surfaces is the compositor's, the rest the rays'.
    const std::string volume = fmt::format("reference:samples={}", request_.reference_samples);
    const std::vector<VolumeChoice> volumes = parse_volumes(volume, {});
    const std::vector<SurfaceChoice> shadows = parse_surfaces("reference", {});
    frame::FrameImages images = render_once(volumes[0], shadows[0]);
    images.distance = surfaces.distance;
    images.visibility = surfaces.visibility;
    comparison.exposure = request_.exposure ? Exposure{*request_.exposure, false}
                                            : Exposure{automatic_exposure(images.radiance), true};
    std::map<std::string, std::string> metadata =
        metadata_of(volume, "reference", command("reference", volume, "reference"));
    metadata["airlight.self-error"] = fmt::format("{}", airlight.self_error);
    write_exr(request_.directory / "reference.exr", exr_image(images, metadata));
    write_png(request_.directory / "reference.png", images.radiance, images.size, comparison.exposure.value);
  }

  frame::FrameImages render_once(const VolumeChoice& volume, const SurfaceChoice& surface) {
    const auto airlight = volume.method->make(context_, reference_, volume.settings);
    const auto shadow = surface.method->make(context_, reference_, surface.settings);
    gpu::StageTimer off(nullptr);
    frame_.render(request_.view, *shadow, *airlight, off);
    return frame_.read();
  }

  struct TimedFrame {
    double ms;
    std::map<std::string, double> stages_ms;  ///< empty unless timed
    SharedReference::Work work;
  };

  TimedFrame render_timed(frame::SurfaceShadow& shadow, frame::Airlight& airlight, bool with_stages) {
    gpu::StageTimer timer(with_stages ? &context_ : nullptr);
    reference_.take_work();
    context_.finish();
    const Clock::time_point start = Clock::now();
    frame_.render(request_.view, shadow, airlight, timer);
    context_.finish();
    TimedFrame timed{milliseconds_since(start), timer.milliseconds(), reference_.take_work()};
    // An image that was kept costs what it cost when it was traced.
    timed.ms += timed.work.kept_airlight_ms + timed.work.kept_surface_ms;
    if (with_stages && timed.work.kept_airlight_ms > 0.0)
      timed.stages_ms["integrate"] += timed.work.kept_airlight_ms;
    if (with_stages && timed.work.kept_surface_ms > 0.0)
      timed.stages_ms["surface_query"] += timed.work.kept_surface_ms;
    return timed;
  }

  void time(Run& run, frame::SurfaceShadow& shadow, frame::Airlight& airlight) {
    const auto progress = [&](double fraction) {
      if (request_.progress) request_.progress(fmt::format("{} × {}", run.volume, run.surface), fraction);
    };
    progress(0.0);
    std::vector<TimedFrame> staged = {render_timed(shadow, airlight, true)};
    std::vector<double> frames = {staged[0].ms}, tracing = {staged[0].work.airlight_ms};
    run.rays = staged[0].work.airlight_rays;
    if (staged[0].ms <= k_slow_frame_ms) {
      staged.clear();  // that one was the warm-up
      frames.clear();
      tracing.clear();
      while (staged.size() < k_staged_frames) staged.push_back(render_timed(shadow, airlight, true));
      for (int i = 0; i < request_.frames; ++i) {
        const TimedFrame timed = render_timed(shadow, airlight, false);
        frames.push_back(timed.ms);
        tracing.push_back(timed.work.airlight_ms);
        progress(static_cast<double>(i + 1) / request_.frames);
      }
    }
    for (const auto& stage : staged[0].stages_ms) {
      std::vector<double> times;
      for (const TimedFrame& timed : staged) times.push_back(timed.stages_ms.at(stage.first));
      run.stages_ms[stage.first] = median(times);
    }
    run.frame_ms = median(frames);
    run.frames = static_cast<int>(frames.size());
    if (run.rays > 0) run.mrays_per_s = static_cast<double>(run.rays) / (1e3 * median(tracing));
  }

  Run run(const VolumeChoice& volume, const SurfaceChoice& surface, const Comparison& comparison) {
    Run run;
    run.volume = volume.spec;
    run.surface = surface.spec;
    run.name = file_stem(volume.spec) + "+" + file_stem(surface.spec);
    run.is_judged = volume.method->is_judged;
    run.settings = volume.values();
    run.surface_settings = surface.values();
    run.command = command(run.name, volume.spec, surface.spec);

    const auto airlight = volume.method->make(context_, reference_, volume.settings);
    const auto shadow = surface.method->make(context_, reference_, surface.settings);
    time(run, *shadow, *airlight);
    run.bytes = frame_.bytes();
    if (!airlight->needs_shadow_map() && !shadow->needs_shadow_map()) run.bytes.erase("shadow_map");
    for (const auto& [name, bytes] : airlight->bytes()) run.bytes[name] += bytes;
    for (const auto& [name, bytes] : shadow->bytes()) run.bytes[name] += bytes;

    const frame::FrameImages images = frame_.read();
    const std::vector<glm::vec3>& truth = reference_.converged(request_.reference_samples).radiance;
    const reference::SurfaceImage& surfaces = reference_.surfaces();
    run.airlight_error = airlight_error(floats(images.airlight), floats(truth));
    run.same_surface_error =
        same_surface_error(floats(images.airlight), images.distance, floats(truth), surfaces.distance);
    run.surface_error =
        surface_error(images.visibility, images.distance, surfaces.visibility, surfaces.distance);

    const auto file = [&](const char* ending) { return request_.directory / (run.name + ending); };
    write_exr(file(".exr"), exr_image(images, metadata_of(volume.spec, surface.spec, run.command)));
    write_png(file(".png"), images.radiance, images.size, comparison.exposure.value);
    write_png(file("_error.png"), error_colours(images.airlight, truth), images.size, 1.0f);
    if (request_.debug) {
      run.debug_images =
          write_debug_images(*airlight, run.name, metadata_of(volume.spec, surface.spec, run.command));
    }
    return run;
  }

  /// Draws one more frame for them.
  std::vector<Run::DebugImage> write_debug_images(frame::Airlight& airlight, const std::string& run_name,
                                                  std::map<std::string, std::string> metadata) {
    frame::NoShadow no_shadow;
    DebugProbe probe(airlight);
    gpu::StageTimer off(nullptr);
    frame_.render(request_.view, no_shadow, probe, off);
    std::vector<Run::DebugImage> written;
    for (const frame::DebugImage& image : probe.images()) {
      const std::string name = run_name + "_" + image.name;
      const float largest = *std::max_element(image.values.begin(), image.values.end());
      const float white = largest > 0.0f ? largest : 1.0f;
      metadata["airlight.caption"] = image.caption;
      write_exr(request_.directory / (name + ".exr"), {image.size, {{"Y", image.values}}, metadata});
      const std::vector<glm::vec3> grey(image.values.begin(), image.values.end());
      write_png(request_.directory / (name + ".png"), grey, image.size, 1.0f / white);
      written.push_back({name, image.caption, white});
    }
    return written;
  }

  /// The command that repeats one run, into a folder of its own.
  std::string command(const std::string& name, const std::string& volume, const std::string& surface) const {
    return fmt::format("{} --volume {} --surface {} -o {}", request_.command, shell_quote(volume),
                       shell_quote(surface), shell_quote((request_.directory / name).string()));
  }

  std::map<std::string, std::string> metadata_of(const std::string& volume, const std::string& surface,
                                                 const std::string& command) const {
    std::map<std::string, std::string> metadata = {
        {"airlight.version", version()},
        {"airlight.command", command},
        {"airlight.scene", request_.scene_name},
        {"airlight.volume", volume},
        {"airlight.surface", surface},
        {"airlight.shadow-map", fmt::format("{}", request_.shadow_map_size)},
    };
    for (const auto& [option, value] : view_options(request_.view)) metadata["airlight." + option] = value;
    return metadata;
  }

  gpu::Context& context_;
  const CompareRequest& request_;
  frame::Frame frame_;
  SharedReference reference_;
};

}  // namespace

Comparison compare(gpu::Context& context, const CompareRequest& request) {
  return Comparer(context, request).compare();
}

Image exr_image(const frame::FrameImages& images, std::map<std::string, std::string> metadata) {
  Image image{.size = images.size, .channels = {}, .metadata = std::move(metadata)};
  const auto add = [&](const std::string& prefix, const std::vector<glm::vec3>& values) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<float>& plane = image.channels[prefix + "RGB"[channel]];
      plane.reserve(values.size());
      for (const glm::vec3& value : values) plane.push_back(value[channel]);
    }
  };
  add("", images.radiance);
  add("airlight.", images.airlight);
  image.channels["surface.Y"] = images.visibility;
  image.channels["distance.Y"] = images.distance;
  return image;
}

float automatic_exposure(const std::vector<glm::vec3>& radiance) {
  if (radiance.empty()) return 1.0f;
  std::vector<float> brightest;
  brightest.reserve(radiance.size());
  for (const glm::vec3& value : radiance) brightest.push_back(std::max({value.x, value.y, value.z}));
  std::sort(brightest.begin(), brightest.end());
  const float percentile = brightest[(brightest.size() - 1) * 95 / 100];
  const float white = percentile > 0.0f ? percentile : brightest.back();
  const float exposure = 0.8f / white;
  return white > 0.0f && std::isfinite(exposure) ? exposure : 1.0f;
}

std::vector<glm::vec3> error_colours(const std::vector<glm::vec3>& x, const std::vector<glm::vec3>& r) {
  const auto grey = [](const glm::vec3& value) {
    return (glm::dvec3(value).x + glm::dvec3(value).y + glm::dvec3(value).z) / 3.0;
  };
  double mean = 0.0;
  for (const glm::vec3& value : r) mean += grey(value) / static_cast<double>(r.size());

  const glm::vec3 white(1.0f), bright(0.5f, 0.0f, 0.0f), dark(0.0f, 0.05f, 0.5f);
  std::vector<glm::vec3> colours;
  colours.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = grey(x[i]) - grey(r[i]);
    double depth = difference == 0.0 ? 0.0 : 1.0;  // against a black reference every error is infinite
    if (difference != 0.0 && mean > 0.0) {
      const double decades =
          std::log(std::abs(difference) / mean / k_error_white) / std::log(k_error_full / k_error_white);
      depth = std::clamp(decades, 0.0, 1.0);
    }
    colours.push_back(glm::mix(white, difference > 0.0 ? bright : dark, static_cast<float>(depth)));
  }
  return colours;
}

std::string shell_quote(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("_-+=:,./@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace airlight::quality
