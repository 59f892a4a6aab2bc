#include "quality/tune.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "app/settings.h"
#include "quality/first_look.h"
#include "quality/results.h"
#include "scene/numbers.h"
#include "scene/transmission.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

constexpr std::size_t k_most_of_each = 24;  ///< settings of a method that are tried where none is named

quality::TuneGoal goal_of(const Options& options) {
  using Kind = quality::TuneGoal::Kind;
  std::optional<quality::TuneGoal> goal;
  for (const auto& [name, kind] : {std::pair("max-error", Kind::error), std::pair("max-ms", Kind::ms),
                                   std::pair("max-bytes", Kind::bytes)}) {
    const auto text = options.get(name);
    if (!text) continue;
    const std::string where = fmt::format("--{}", name);
    if (goal) throw Error(ExitCode::usage, where, "it is the second goal", "give one");
    const double limit = scene::parse_number(where, *text);
    if (!(limit > 0.0)) throw Error(ExitCode::usage, where, fmt::format("{} is not above 0", *text));
    goal = {kind, limit};
  }
  if (!goal)
    throw Error(ExitCode::usage, "tune", "it has no goal",
                "give --max-error X (an rrmse, as in 0.01), --max-ms T or --max-bytes B");
  return *goal;
}

/// An option's name or value as a word of GLSL and of C++.
std::string identifier(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return text;
}

/// The method's counts, in the words that GLSL and C++ share; the rest as comments.
std::string constants_of(const quality::TunedSetting& tuned) {
  std::string text = fmt::format("// {}\n", tuned.setting.volume.spec);
  for (const auto& [name, value] : tuned.setting.volume.values()) {
    if (const int* count = std::get_if<int>(&value))
      text += fmt::format("const int k_{} = {};\n", identifier(name), *count);
    else
      text += fmt::format("// {} = {}\n", name, frame::text_of(value));
  }
  if (tuned.setting.shadow_map)
    text += fmt::format("const int k_shadow_map = {};\n", *tuned.setting.shadow_map);
  return text;
}

/// Lines of a shot.
std::string toml_of(const quality::TunedSetting& tuned) {
  std::string text = fmt::format("[methods]\nvolume = \"{}\"\nsurface = \"{}\"\n", tuned.setting.volume.spec,
                                 tuned.setting.surface.spec);
  if (tuned.setting.shadow_map) text += fmt::format("shadow_map = {}\n", *tuned.setting.shadow_map);
  return text;
}

std::string json_of(const quality::Tuned& tuned) {
  const quality::TunedSetting& best = tuned.best;
  nlohmann::ordered_json json = {{"volume", best.setting.volume.spec},
                                 {"surface", best.setting.surface.spec},
                                 {"shadow_map", nullptr},
                                 {"error", best.error},
                                 {"frame_ms", best.frame_ms},
                                 {"bytes", best.bytes},
                                 {"confidence", tuned.confidence},
                                 {"met", tuned.is_met},
                                 {"tried",
                                  {{"settings", tuned.settings},
                                   {"frames", tuned.frames},
                                   {"views", tuned.views},
                                   {"truth_share", tuned.truth_share}}}};
  if (best.setting.shadow_map) json["shadow_map"] = *best.setting.shadow_map;
  for (const quality::Tuned::Knob& knob : tuned.knobs)
    json["knobs"].push_back({{"name", knob.name},
                             {"from", knob.from},
                             {"to", knob.to},
                             {"error_ratio", knob.error_ratio},
                             {"ms_ratio", knob.ms_ratio}});
  return json.dump(2) + "\n";
}

std::string text_of(const quality::Tuned& tuned, const std::string& command) {
  const quality::TunedSetting& best = tuned.best;
  std::string text = fmt::format(
      "{}{}: rrmse {:.3g} % ({:.0f} % sure), {:.1f} ms, {:.1f} MiB\n"
      "tried {} settings in {} frames of {} view{}, with {:.2g} % of the truth's pixels\n\n{}\n\n{}\n{}",
      tuned.is_met ? "" : "nothing reaches the goal; nearest is ", best.setting.volume.spec,
      100.0 * best.error, 100.0 * tuned.confidence, best.frame_ms,
      static_cast<double>(best.bytes) / (1 << 20), tuned.settings, tuned.frames, tuned.views,
      tuned.views == 1 ? "" : "s", 100.0 * tuned.truth_share, command, toml_of(best), constants_of(best));
  if (!tuned.knobs.empty())
    text += fmt::format("\n{:<20} {:>14} {:>14} {:>8} {:>8}\n", "knob", "from", "to", "error ×", "time ×");
  for (const quality::Tuned::Knob& knob : tuned.knobs)
    text += fmt::format("{:<20} {:>14} {:>14} {:>8.2f} {:>8.2f}\n", knob.name, knob.from, knob.to,
                        knob.error_ratio, knob.ms_ratio);
  return text;
}

}  // namespace

void tune(const Options& options) {
  // Everything that can be wrong with the command is found before the driver is woken.
  const quality::TuneGoal goal = goal_of(options);
  const std::vector<quality::CommonOption> common = common_method_options(options);
  std::vector<quality::VolumeChoice> volumes;
  if (const auto list = options.get("volume")) volumes = expanded_volumes(*list, common);
  std::vector<quality::SurfaceChoice> surfaces = parse_surfaces(options);
  if (surfaces.size() != 1) throw Error(ExitCode::usage, "--surface", "it names several methods", "name one");
  const std::vector<int> shadow_maps =
      expanded_shadow_maps(options.get("shadow-map").value_or("1024,2048,4096"));
  const int rounds = scene::parse_count("--frames", options.get("frames").value_or("7"));
  const auto json = options.get("json");
  if (json && *json != "-") require_writable(*json);

  Subject subject = make_subject(options);
  std::size_t refused = 0;
  const bool is_named = !volumes.empty();
  if (!is_named) volumes = every_volume(options, subject, k_most_of_each, refused);
  require_read(options, volumes, surfaces);
  const quality::AutomaticCounts automatic = fit_to_view(volumes, surfaces, subject);
  // What cannot show what light passes would be judged by another scene.
  if (!is_named && scene::transmits(subject.scene.geometry))
    std::erase_if(volumes,
                  [](const quality::VolumeChoice& volume) { return !volume.method->traits.transmits; });
  if (volumes.empty())
    throw Error(ExitCode::usage, "tune", "no method that it may choose from can show the scene");
  if (!options.quiet) say_warnings(subject.scene.report);
  require_memory({.size = subject.view.size,
                  .bytes_per_pixel = bytes_of_compare(subject) + shadow_maps.size() * k_bytes_of_render,
                  .shadow_map = *std::max_element(shadow_maps.begin(), shadow_maps.end()),
                  .triangles = subject.scene.geometry.triangles.size(),
                  .looks = bytes_of_looks(subject.scene.geometry),
                  .scenes = subject.scenes() * static_cast<int>(shadow_maps.size())});

  const quality::Subject tuned_subject{"", options.scene, subject.scene, subject.views(),
                                       subject.path.has_value()};
  quality::Tuned tuned;
  {
    ProgressLine progress(options.quiet);
    gpu::Context context;
    const bool asks_for_error = goal.kind == quality::TuneGoal::Kind::error;
    quality::take_first_looks(context, subject.scene.geometry, subject.views(), volumes, automatic,
                              shadow_maps[0], asks_for_error ? goal.limit : quality::k_first_look_error,
                              progress.follower());
    tuned = quality::tune(context, {.subject = tuned_subject,
                                    .settings = product(volumes, surfaces, shadow_maps),
                                    .goal = goal,
                                    .rounds = rounds,
                                    .explains = options.explain,
                                    .progress = progress.follower()});
  }
  Options of_render = options;
  of_render.command = "render";
  std::string command = command_of_pair(of_render, tuned.best.setting.volume, tuned.best.setting.surface,
                                        {"max-error", "max-ms", "max-bytes", "frames", "json", "shadow-map"});
  if (tuned.best.setting.shadow_map)
    command += fmt::format(" --shadow-map {}", *tuned.best.setting.shadow_map);
  if (json && *json != "-") quality::write_text(*json, json_of(tuned));
  print(json == "-" ? json_of(tuned) : text_of(tuned, command + " -o tuned.exr"));
  if (!tuned.is_met)
    throw Error(ExitCode::threshold_missed, "tune", "no setting reaches the goal",
                "ask for less, or name more settings with --volume");
}

}  // namespace airlight::app
