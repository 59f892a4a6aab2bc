#include "quality/compare.h"

#include <algorithm>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "quality/darkness.h"
#include "quality/judge.h"
#include "quality/measure.h"
#include "quality/pictures.h"
#include "quality/sweep.h"
#include "quality/truth.h"

namespace airlight::quality {
namespace {

/// A spec as a part of a file name: "vsv:integral=riemann" becomes "vsv_integral-riemann".
std::string file_stem(std::string spec) {
  for (char& c : spec) {
    if (c == ':') c = '_';
    if (c == '=') c = '-';
  }
  return spec;
}

/// The command that repeats one run, into a folder of its own.
std::string command_of(const CompareRequest& request, const std::string& name, const VolumeChoice& volume,
                       const SurfaceChoice& surface) {
  return fmt::format("{} -o {}", request.command(volume, surface),
                     shell_quote((request.directory / name).string()));
}

std::map<std::string, std::string> metadata_of(const CompareRequest& request, const std::string& volume,
                                               const std::string& surface, const std::string& command) {
  std::map<std::string, std::string> metadata = {
      {"airlight.version", version()},
      {"airlight.command", command},
      {"airlight.scene", request.scene_name},
      {"airlight.volume", volume},
      {"airlight.surface", surface},
      {"airlight.shadow-map", fmt::format("{}", request.shadow_map_size)},
  };
  for (const auto& [option, value] : view_options(request.view)) metadata["airlight." + option] = value;
  return metadata;
}

/// Of the view that is looked at.
Truth truth_of(Measurer& measurer, const scene::View& view) {
  return trace_truth(measurer.reference(), view, measurer.surface_points());
}

/// What the truth of the view that is looked at looks like: surfaces are the frame's, airlight and distance
/// the rays'.
frame::FrameImages images_of_truth(Measurer& measurer, const Truth& truth) {
  frame::FrameImages images = measurer.render(parse_volumes("reference")[0], parse_surfaces("reference")[0]);
  images.distance = truth.distance;
  return images;
}

/// Of all previews. @param radiance the truth's, of a path's first frame
Exposure choose_exposure(const CompareRequest& request, const std::vector<glm::vec3>& radiance) {
  return request.exposure ? Exposure{*request.exposure, false, is_black(radiance)}
                          : Exposure{automatic_exposure(radiance), true, is_black(radiance)};
}

void show(const CompareRequest& request, const std::string& name, const frame::FrameImages& images) {
  if (request.show) request.show(name, images);
}

void write_truth(const CompareRequest& request, const frame::FrameImages& images, const Truth& truth,
                 const Exposure& exposure) {
  const VolumeChoice volume = parse_volumes("reference")[0];
  const SurfaceChoice surface = parse_surfaces("reference")[0];
  auto metadata =
      metadata_of(request, volume.spec, surface.spec, command_of(request, "reference", volume, surface));
  show(request, "reference", images);
  metadata["airlight.bound"] = fmt::format("{}", truth.figures.bound);
  write_frame(request.directory / "reference.exr", images, metadata);
  write_png(request.directory / "reference.png", images.radiance, images.size, exposure.value,
            request.scene.tone_map);
}

/// The previews of a run. @param ending of their names, before the format's
void write_previews(const CompareRequest& request, const std::string& name, const std::string& ending,
                    const frame::FrameImages& images, const Truth& truth, const Truth& of_surfaces,
                    const Exposure& exposure) {
  const auto file = [&](const char* kind) { return request.directory / (name + kind + ending + ".png"); };
  write_png(file(""), images.radiance, images.size, exposure.value, request.scene.tone_map);
  write_png(file("_error"), error_colours(images.airlight, truth.airlight), images.size, 1.0f);
  write_png(file("_surface"), surface_colours(images, of_surfaces.verdicts), images.size, 1.0f);
}

std::vector<Run::DebugImage> write_debug_images(const CompareRequest& request, const Run& run,
                                                const std::vector<frame::DebugImage>& images) {
  auto metadata = metadata_of(request, run.volume, run.surface, run.command);
  std::vector<Run::DebugImage> written;
  for (const frame::DebugImage& image : images) {
    const std::string name = run.name + "_" + image.name;
    const float largest = *std::max_element(image.values.begin(), image.values.end());
    const float white = largest > 0.0f ? largest : 1.0f;
    metadata["airlight.caption"] = image.caption;
    write_exr(request.directory / (name + ".exr"), {image.size, {{"Y", image.values}}, metadata});
    const std::vector<glm::vec3> grey(image.values.begin(), image.values.end());
    write_png(request.directory / (name + ".png"), grey, image.size, 1.0f / white);
    written.push_back({name, image.caption, white});
  }
  return written;
}

/// Gives each run the ratio of the fastest yardstick's time to its own.
void compare_times(std::vector<Run>& runs) {
  double fastest_ms = 0.0;
  for (const Run& run : runs) {
    if (run.is_yardstick && (fastest_ms == 0.0 || run.cost.frame_ms < fastest_ms))
      fastest_ms = run.cost.frame_ms;
  }
  for (Run& run : runs) run.march_ratio = fastest_ms / run.cost.frame_ms;
}

/// Truths of a path's frames, of which it writes what they look like.
std::vector<Truth> trace_path(const CompareRequest& request, Measurer& measurer, Comparison& comparison) {
  const std::vector<scene::View>& views = request.path->views;
  std::vector<Truth> truths;
  ComparedPath& path = comparison.path.emplace();
  path.seconds = request.path->seconds;
  comparison.truth = {};
  const double count = static_cast<double>(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    measurer.look_at(views[i]);
    const Truth& truth = truths.emplace_back(truth_of(measurer, views[i]));
    const frame::FrameImages images = images_of_truth(measurer, truth);
    if (i == 0) comparison.exposure = choose_exposure(request, images.radiance);
    const std::string name = fmt::format("reference{}", scene::frame_ending(i));
    show(request, name, images);
    write_png(request.directory / (name + ".png"), images.radiance, images.size, comparison.exposure.value,
              request.scene.tone_map);

    const TruthFigures& figures = truth.figures;
    path.frames.push_back(
        {.time = request.path->time(i),
         .motion = i == 0 ? scene::Motion::all : scene::motion_between(views[i - 1], views[i]),
         .truth = figures});
    TruthFigures& all = comparison.truth;
    all.bound = std::max(all.bound, figures.bound);
    all.ms += figures.ms;
    all.shadows_per_pixel += figures.shadows_per_pixel / count;
    all.lit_runs_per_pixel += figures.lit_runs_per_pixel / count;
    all.mean_airlight += figures.mean_airlight / count;
    all.floor += figures.floor / count;
  }
  return truths;
}

}  // namespace

Run judged_run(Measurer& measurer, std::span<const scene::View> views, bool is_path,
               std::span<const Truth> truths, const VolumeChoice& volume, const SurfaceChoice& surface,
               int frames, const Look& look) {
  Run run;
  run.volume = volume.spec;
  run.surface = surface.spec;
  run.name = file_stem(volume.spec) + "+" + file_stem(surface.spec);
  run.is_judged = volume.method->traits.is_judged();
  run.is_yardstick = volume.method->traits.is_yardstick;
  run.settings = volume.values();
  run.surface_settings = surface.values();
  const auto judge_by = [&](const Truth& truth, const frame::FrameImages& images) {
    return judge(images, truth.shown_by(volume.method->traits), truth.shown_by(surface.method->traits));
  };
  if (!is_path) {
    const Measurer::Measurement measured = measurer.measure(volume, surface, frames);
    run.cost = measured.cost;
    run.errors = judge_by(truths[0], measured.images);
    if (look) look(run, 0, measured.images);
    return run;
  }
  run.path.resize(views.size());
  ErrorImage before;
  const Measurer::PathMeasurement measured = measurer.measure_path(
      volume, surface, views, frames, [&](std::size_t i, const frame::FrameImages& images) {
        run.path[i].errors = judge_by(truths[i], images);
        ErrorImage error = error_image(images, truths[i].shown_by(volume.method->traits));
        if (i > 0) run.path[i].flicker = flicker(before, error);
        before = std::move(error);
        if (look) look(run, i, images);
        if (is_worse(run.path[i].errors.airlight, run.path[run.worst_frame].errors.airlight))
          run.worst_frame = i;
      });
  run.cost = measured.cost;
  for (std::size_t i = 0; i < run.path.size(); ++i) run.path[i].cost = measured.frames[i];
  run.errors = run.path[run.worst_frame].errors;
  return run;
}

Comparison compare(gpu::Context& context, const CompareRequest& request) {
  Comparison comparison;
  const std::span<const scene::View> views =
      request.path ? std::span<const scene::View>(request.path->views) : std::span(&request.view, 1);
  comparison.scene = request.scene_name;
  comparison.subject = hash_of_subject(request.scene.geometry, views);
  comparison.triangles = request.scene.geometry.triangles.size();
  comparison.report = request.scene.report;
  comparison.view = request.view;
  comparison.shadow_map_size = request.shadow_map_size;
  comparison.device = context.device();
  comparison.cores = std::max(1u, std::thread::hardware_concurrency());

  // The truth, once nothing else can fail.
  Measurer measurer(context, request.scene.geometry, request.view, request.shadow_map_size, request.progress,
                    request.cache);
  measurer.try_out(request.volumes, request.surfaces);
  std::vector<Truth> truths;
  if (request.path) {
    truths = trace_path(request, measurer, comparison);
  } else {
    const Truth& truth = truths.emplace_back(truth_of(measurer, request.view));
    const frame::FrameImages images = images_of_truth(measurer, truth);
    comparison.truth = truth.figures;
    comparison.exposure = choose_exposure(request, images.radiance);
    write_truth(request, images, truth, comparison.exposure);
  }
  if (comparison.exposure.is_of_black)
    comparison.report.warnings.push_back("the reference is black: " +
                                         why_black(request.scene.geometry, request.view));

  // Every pair: measure, judge, write.
  for (const VolumeChoice& volume : request.volumes) {
    for (const SurfaceChoice& surface : request.surfaces) {
      std::string command;
      Run run = judged_run(measurer, views, request.path, truths, volume, surface, request.frames,
                           [&](const Run& judged, std::size_t i, const frame::FrameImages& images) {
                             command = command_of(request, judged.name, volume, surface);
                             const std::string ending = request.path ? scene::frame_ending(i) : "";
                             show(request, judged.name + ending, images);
                             if (!request.path)
                               write_frame(request.directory / (judged.name + ".exr"), images,
                                           metadata_of(request, judged.volume, judged.surface, command));
                             write_previews(request, judged.name, ending, images,
                                            truths[i].shown_by(volume.method->traits),
                                            truths[i].shown_by(surface.method->traits), comparison.exposure);
                           });
      run.command = command;
      if (is_read("shadow-map", {&volume, 1}, {&surface, 1})) run.shadow_map = request.shadow_map_size;
      run.key = key_of(comparison.subject, {volume, surface, run.shadow_map});
      if (request.debug && !request.path)
        run.debug_images = write_debug_images(request, run, measurer.debug_images(volume));
      comparison.runs.push_back(std::move(run));
    }
  }
  compare_times(comparison.runs);
  return comparison;
}

}  // namespace airlight::quality
