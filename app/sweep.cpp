#include "quality/sweep.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "app/settings.h"
#include "quality/axes.h"
#include "quality/first_look.h"
#include "scene/numbers.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

constexpr std::size_t k_most_of_all = 40;  ///< settings of each method that --all takes

/// The axes of the file and of the options.
quality::Axes axes_of(const Options& options) {
  quality::Axes axes;
  if (const auto file = options.get("axes")) axes = quality::read_axes(*file);
  const auto add = [&](const char* name, std::optional<std::string>& axis) {
    const auto text = options.get(name);
    if (text && axis)
      throw Error(ExitCode::usage, fmt::format("--{}", name), "the file of axes has it too",
                  "leave one of them out");
    if (text) axis = text;
  };
  add("volume", axes.volumes);
  add("surface", axes.surfaces);
  add("shadow-map", axes.shadow_maps);
  if (options.all && axes.volumes)
    throw Error(ExitCode::usage, "--all", "it takes every method, and some are named too",
                "leave one of them out");
  if (!options.all && !axes.volumes)
    throw Error(ExitCode::usage, "--volume", "it is missing",
                "give lists of values, as in --volume 'vsv:alpha={64,128,256}', or --axes, or --all");
  return axes;
}

}  // namespace

void sweep(const Options& options) {
  // Everything that can be wrong with the command is found before the driver is woken.
  const quality::Axes axes = axes_of(options);
  const std::vector<quality::CommonOption> common = common_method_options(options);
  std::vector<quality::VolumeChoice> volumes;
  if (axes.volumes) volumes = expanded_volumes(*axes.volumes, common);
  std::vector<quality::SurfaceChoice> surfaces =
      expanded_surfaces(axes.surfaces.value_or("shadow-map"), common);
  const std::vector<int> shadow_maps = expanded_shadow_maps(axes.shadow_maps.value_or("2048"));
  const quality::Shard shard = quality::parse_shard("--shard", options.get("shard").value_or("1/1"));
  const int rounds = scene::parse_count("--frames", options.get("frames").value_or("9"));
  const std::vector<quality::VolumeChoice> baselines =
      quality::parse_volumes(options.get("baseline").value_or("vsv"), common);
  if (baselines.size() != 1)
    throw Error(ExitCode::usage, "--baseline", "it names several methods", "name one");
  Subject subject = make_subject(options);
  std::size_t refused = 0;
  if (options.all) volumes = every_volume(options, subject, k_most_of_all, refused);
  require_read(options, volumes, surfaces);
  const quality::AutomaticCounts automatic = fit_to_view(volumes, surfaces, subject);
  quality::VolumeChoice baseline_volume = baselines[0];
  baseline_volume.fit(subject.views());

  const std::filesystem::path folder = output_folder(options);
  require_folder(folder);
  if (!options.quiet) {
    say_warnings(subject.scene.report);
    if (refused > 0) say(fmt::format("airlight: warning: settings that cannot show the view: {}", refused));
  }
  require_memory(
      {.size = subject.view.size,
       .bytes_per_pixel = bytes_of_compare(subject) + (shadow_maps.size() > 1 ? k_bytes_of_render : 0),
       .shadow_map = *std::max_element(shadow_maps.begin(), shadow_maps.end()),
       .triangles = subject.scene.geometry.triangles.size(),
       .looks = bytes_of_looks(subject.scene.geometry),
       .scenes = subject.scenes()});

  const quality::Subject swept{quality::hash_of_subject(subject.scene.geometry, subject.views()),
                               options.scene, subject.scene, subject.views(), subject.path.has_value()};
  const quality::SurfaceChoice usual_surface = quality::parse_surfaces("shadow-map")[0];
  const auto command = [&](const quality::Setting& setting) {
    Options of_run = options;
    of_run.command = "compare";
    const std::vector<std::string> without = {"axes", "baseline", "shard", "shadow-map", "frames"};
    std::string line = command_of_pair(of_run, setting.volume, setting.surface, without);
    if (setting.shadow_map) line += fmt::format(" --shadow-map {}", *setting.shadow_map);
    return line;
  };
  quality::RunFile file(folder, shard);
  quality::SweepCount count;
  {
    ProgressLine progress(options.quiet);
    gpu::Context context;
    quality::take_first_looks(context, subject.scene.geometry, subject.views(), volumes, automatic,
                              shadow_maps[0], quality::k_first_look_error, progress.follower());
    count = quality::sweep(
        context, file,
        {.subject = swept,
         .settings = quality::distinct_settings(swept.hash, product(volumes, surfaces, shadow_maps), shard),
         .baseline = product({baseline_volume}, {usual_surface}, {shadow_maps[0]})[0],
         .rounds = rounds,
         .cache = options.get("cache").value_or((folder / "truth").string()),
         .command = command,
         .progress = progress.follower()});
  }
  if (!options.quiet)
    say(fmt::format("{}: {} measured, {} were there", file.path().string(), count.measured, count.found));
}

}  // namespace airlight::app
