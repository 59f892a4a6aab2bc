#include "quality/compare.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "quality/first_look.h"
#include "quality/report.h"
#include "scene/numbers.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

/// @throws Error (threshold_missed) naming the worst run, where one is off by more than `limit`. By a dark
/// truth, which nothing is relative to, a run is judged by whether it is as dark: its rmse not above the
/// floor.
void require_accuracy(const quality::Comparison& comparison, double limit) {
  const quality::Run* worst = nullptr;
  for (const quality::Run& run : comparison.runs) {
    if (run.is_judged && (!worst || run.errors.airlight.rmse > worst->errors.airlight.rmse)) worst = &run;
  }
  if (!worst) return;
  const quality::TruthFigures& truth =
      comparison.path ? comparison.path->frames[worst->worst_frame].truth : comparison.truth;
  const std::string what = comparison.path
                               ? fmt::format("--max-error {}, frame {}", limit, worst->worst_frame)
                               : fmt::format("--max-error {}", limit);
  const quality::AirlightError& error = worst->errors.airlight;
  if (truth.is_dark()) {
    if (error.rmse <= truth.floor) return;
    throw Error(
        ExitCode::threshold_missed, what,
        fmt::format("{} × {} is off by {:.2g} W/(m2 sr) (rmse) where the reference is dark, at most {:.2g}",
                    worst->volume, worst->surface, error.rmse, truth.floor),
        "give the method more cells or samples, or another view");
  }
  // What the reference itself cannot vouch for is not claimed.
  if (std::max(error.rrmse, truth.bound) <= limit) return;
  throw Error(ExitCode::threshold_missed, what,
              fmt::format("{} × {} is off by {:.4g} (rrmse; the reference's own is below {:.2g})",
                          worst->volume, worst->surface, error.rrmse, truth.bound),
              "give the method more cells or samples, or allow more");
}

/// @throws Error (threshold_missed) naming the run, and of a path the frame, with the largest part of
/// undecided surface pixels, where that is more than `limit`
void require_decided(const quality::Comparison& comparison, double limit) {
  const quality::Run* worst = nullptr;
  double most = limit;
  std::string what;
  const auto look_at = [&](const quality::Run& run, const quality::Errors& errors, const std::string& where) {
    if (errors.surface.undecided() <= most) return;
    most = errors.surface.undecided();
    worst = &run;
    what = fmt::format("--max-undecided {}{}", limit, where);
  };
  for (const quality::Run& run : comparison.runs) {
    if (run.path.empty()) look_at(run, run.errors, "");
    for (std::size_t i = 0; i < run.path.size(); ++i)
      look_at(run, run.path[i].errors, fmt::format(", frame {}", i));
  }
  if (!worst) return;
  throw Error(ExitCode::threshold_missed, what,
              fmt::format("{:.4g} of the surface pixels of {} × {} are undecided", most, worst->volume,
                          worst->surface),
              "choose a light or a camera that fewer surfaces are edge-on to, or allow more");
}

}  // namespace

void compare(const Options& options) {
  // Everything that can be wrong with the command is found before the driver is woken.
  auto volumes = parse_volumes(options, "vsv,vsv:integral=riemann,reference-march");
  auto surfaces = parse_surfaces(options);
  require_read(options, volumes, surfaces);
  const int shadow_map = shadow_map_size(options);
  const int frames =
      scene::parse_count("--frames", options.get("frames").value_or(options.get("path") ? "1" : "5"));
  if (options.debug && options.get("path"))
    throw Error(ExitCode::usage, "--debug", "there are no such pictures along a path",
                "leave one of them out");
  std::optional<double> limit;
  if (const auto text = options.get("max-error")) {
    limit = scene::parse_number("--max-error", *text);
    if (*limit < 0.0) throw Error(ExitCode::usage, "--max-error", fmt::format("'{}' is negative", *text));
    if (std::none_of(volumes.begin(), volumes.end(),
                     [](const auto& choice) { return choice.method->traits.is_judged(); })) {
      throw Error(ExitCode::usage, "--max-error", "no --volume is judged by it", "add one that is, as vsv");
    }
  }
  std::optional<double> undecided_limit;
  if (const auto text = options.get("max-undecided")) {
    undecided_limit = scene::parse_number("--max-undecided", *text);
    if (*undecided_limit < 0.0 || *undecided_limit > 1.0)
      throw Error(ExitCode::usage, "--max-undecided", fmt::format("'{}' is not between 0 and 1", *text));
  }
  Subject subject = make_subject(options);
  const quality::AutomaticCounts automatic = fit_to_view(volumes, surfaces, subject);
  const std::filesystem::path folder = output_folder(options);
  require_folder(folder);
  const auto json = options.get("json");
  if (json && *json != "-") require_writable(*json);
  const std::unique_ptr<quality::Tev> tev = open_tev(options.tev);
  if (!options.quiet) say_warnings(subject.scene.report);

  require_memory({.size = subject.view.size,
                  .bytes_per_pixel = bytes_of_compare(subject),
                  .shadow_map = quality::is_read("shadow-map", volumes, surfaces) ? shadow_map : 0,
                  .triangles = subject.scene.geometry.triangles.size(),
                  .looks = bytes_of_looks(subject.scene.geometry),
                  .scenes = subject.scenes()});
  const bool has_automatic_counts =
      std::any_of(automatic.begin(), automatic.end(), [](const auto& names) { return !names.empty(); });
  const auto command = [&](const quality::VolumeChoice& volume, const quality::SurfaceChoice& surface) {
    // What is asked of all pairs is left out.
    std::vector<std::string> without = {"json", "max-undecided"};
    if (!has_automatic_counts) without.emplace_back("max-error");
    return command_of_pair(options, volume, surface, without);
  };
  std::function<void(const std::string&, const frame::FrameImages&)> show;
  if (tev) show = [&](const std::string& name, const frame::FrameImages& images) { tev->show(name, images); };
  quality::Comparison comparison;
  {
    ProgressLine progress(options.quiet);
    gpu::Context context;
    quality::take_first_looks(context, subject.scene.geometry, subject.views(), volumes, automatic,
                              shadow_map, limit.value_or(quality::k_first_look_error), progress.follower());
    comparison = quality::compare(context, {.scene_name = options.scene,
                                            .scene = subject.scene,
                                            .view = subject.view,
                                            .path = subject.path ? &*subject.path : nullptr,
                                            .volumes = volumes,
                                            .surfaces = surfaces,
                                            .shadow_map_size = shadow_map,
                                            .frames = frames,
                                            .exposure = subject.exposure,
                                            .directory = folder,
                                            .cache = options.get("cache").value_or(""),
                                            .debug = options.debug,
                                            .command = command,
                                            .progress = progress.follower(),
                                            .show = show});
  }

  if (options.debug && !options.quiet &&
      std::all_of(comparison.runs.begin(), comparison.runs.end(),
                  [](const quality::Run& run) { return run.debug_images.empty(); })) {
    say("airlight: warning: --debug: no --volume has pictures to show; vsv has");
  }
  if (!options.quiet) say_of_tev(tev.get());
  // Those of the scene are said already.
  if (!options.quiet) {
    const std::size_t said = subject.scene.report.warnings.size();
    for (const std::string& warning : std::span(comparison.report.warnings).subspan(said))
      say("airlight: warning: " + warning);
  }
  const std::string results = quality::results_json(comparison);
  quality::write_text(folder / "results.json", results);
  quality::write_text(folder / "report.html", quality::report_html({&folder, 1}));
  if (json && *json != "-") quality::write_text(*json, results);
  print(json == "-" ? results : quality::results_table(comparison));
  if (!options.quiet) say_page(folder / "report.html");
  if (limit) require_accuracy(comparison, *limit);
  if (undecided_limit) require_decided(comparison, *undecided_limit);
}

}  // namespace airlight::app
