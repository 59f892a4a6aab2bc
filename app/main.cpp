#include <exception>
#include <new>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "app/output.h"
#include "quality/results.h"
#include "quality/tev.h"
#include "scene/choices.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

/// An option whose value `read_words` takes: the parser knows it for its help, and loses the order in which
/// options are given.
void add_option(CLI::App& command, const OptionLine& line) {
  command
      .add_option_function<std::string>(
          fmt::format("--{}", line.name), [](const std::string&) {}, line.help)
      ->type_name(std::string(line.placeholder))
      ->take_last();
}

/// Of a command that renders.
void add_tev(CLI::App& command, Options& options) {
  command.add_flag(fmt::format("--tev{{{}}}", quality::Tev::k_address), options.tev,
                   fmt::format("also show the images in a running tev as they are rendered; --tev=HOST:PORT "
                               "where it is not at {}",
                               quality::Tev::k_address));
}

/// The scenes of `compare` and of `view` where none is named: one that is quick to trace, and one that is to
/// be looked at.
constexpr const char *k_compared_scene = "window", *k_viewed_scene = "jali";

/// What `render`, `compare`, `sweep` and `view` share.
/// @param usual SCENE where it is left out; empty where it cannot be
CLI::App& add_image_command(CLI::App& app, Options& options, const char* name, const char* description,
                            const std::string& usual = {}) {
  CLI::App& command = *app.add_subcommand(name, description);
  command
      .add_option("SCENE", options.scene,
                  "a built-in scene's name, a shot (.toml), or a .gltf, .glb, .obj or .ply file" +
                      (usual.empty() ? "" : fmt::format(" (default: {})", usual)))
      ->type_name("");
  for (const OptionLine& line : common_options()) add_option(command, line);
  command.add_flag("--quiet", options.quiet, "say nothing but errors");
  command.preparse_callback([&options, name](std::size_t) { options.command = name; });
  return command;
}

/// Reads the options that have a value, and says more than the parser would about a command line that cannot
/// be.
/// @returns Options::given
std::vector<std::pair<std::string, std::string>> read_words(const CLI::App& app, int argc, char** argv) {
  constexpr const char* k_commands =
      "use view, render, compare, sweep, tune, front, report, image, scenes or info";
  if (argc < 2) throw Error(ExitCode::usage, "command line", "it names no command", k_commands);
  if (argv[1][0] == '-') {
    if (app.get_option_no_throw(argv[1])) return {};
    throw Error(ExitCode::usage, argv[1], "there is no such option before a command", k_commands);
  }
  const auto commands = app.get_subcommands([&](const CLI::App* c) { return c->get_name() == argv[1]; });
  if (commands.empty()) throw Error(ExitCode::usage, argv[1], "there is no such command", k_commands);
  const CLI::App& command = *commands[0];
  const std::string help = fmt::format("see airlight {} --help", argv[1]);
  constexpr int k_any = 1 << 30;
  const auto has = [&](const char* name) { return command.get_option_no_throw(name) != nullptr; };
  int names_left = has("DIR") || has("FILE") ? k_any : has("SCENE") ? 1 : 0;
  std::vector<std::pair<std::string, std::string>> given;
  std::set<const CLI::Option*> seen;
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    const bool is_long = word.starts_with("--");
    if (word == "--") break;
    if (word.size() < 2 || word[0] != '-') {
      if (names_left-- == 0) throw Error(ExitCode::usage, word, "it is one word too many", help);
      continue;
    }
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const CLI::Option* option = command.get_option_no_throw(name);
    if (!option) throw Error(ExitCode::usage, name, fmt::format("{} has no such option", argv[1]), help);
    // Each light has its own, as whoever tells lights apart sees to.
    const scene::FieldInfo* field = is_long ? scene::find_field(name.substr(2)) : nullptr;
    const bool is_of_light = field && scene::is_of_light(*field);
    if (!is_of_light && !seen.insert(option).second)
      throw Error(ExitCode::usage, name, "it is given twice", "give it once");
    const bool takes_value = option->get_items_expected_max() > 0, has_value = word.size() > name.size();
    // A flag that stands for a value may be given another.
    const bool stands_for_value =
        !takes_value && is_long && option->get_flag_value(name.substr(2), "") != "true";
    if (!takes_value && has_value && !stands_for_value)
      throw Error(ExitCode::usage, word, fmt::format("{} takes no value", name));
    if (takes_value && !has_value && ++i == argc)
      throw Error(ExitCode::usage, name, fmt::format("its {} is missing", option->get_type_name()), help);
    if (takes_value && is_long)
      given.emplace_back(name.substr(2), has_value ? word.substr(name.size() + 1) : argv[i]);
  }
  return given;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Light shafts in fog by epipolar voxelized shadow volumes, compared with ray tracing.",
               "airlight");
  app.set_version_flag("--version", "airlight " + quality::version());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 an accuracy asked for was missed, 2 usage, 3 bad input or output file,\n"
      "4 the driver cannot.");

  CLI::App& render_command = add_image_command(app, options, "render", "renders one image");
  render_command.add_option("-o", options.output, "the image: OpenEXR; a PNG preview goes beside it")
      ->type_name("FILE.exr");
  add_option(render_command, {"volume", "METHOD", "airlight (default: vsv)"});
  add_option(render_command, {"surface", "METHOD", "surface shadow (default: shadow-map)"});

  add_option(render_command,
             {"video", "FILE.mp4", "along a path, a video of the images' previews too, by ffmpeg"});

  add_option(render_command,
             {"max-error", "X", "rrmse that counts which are auto are to be enough for (default: 0.01)"});
  add_tev(render_command, options);

  CLI::App& view_command =
      add_image_command(app, options, "view", "opens a window to fly through a scene", k_viewed_scene);
  view_command
      .add_option("-o", options.output,
                  "folder for the pictures, shots and paths made there (default: out/SCENE)")
      ->type_name("DIR");
  add_option(view_command, {"volume", "METHOD", "airlight to begin with (default: vsv)"});
  add_option(view_command, {"surface", "METHOD", "surface shadow to begin with (default: shadow-map)"});

  CLI::App& compare_command = add_image_command(
      app, options, "compare", "measures methods against the reference: time, error, images, report",
      k_compared_scene);
  compare_command
      .add_option("-o", options.output,
                  "folder for results.json, report.html and the images (default: out/SCENE)")
      ->type_name("DIR");
  add_option(
      compare_command,
      {"volume", "LIST",
       "methods of airlight, separated by commas (default: vsv,vsv:integral=riemann,reference-march)"});
  add_option(compare_command,
             {"surface", "LIST", "methods of surface shadow, separated by commas (default: shadow-map)"});
  add_option(
      compare_command,
      {"frames", "N",
       "frames timed a run, after warm-up (default: 5); along a path, how often it is timed (default: 1)"});
  add_option(compare_command, {"max-error", "X",
                               "exit with 1 where a method's airlight has an rrmse above this, as in 0.02; "
                               "counts which are auto are to be "
                               "enough for it (default for those: 0.01)"});
  add_option(compare_command,
             {"max-undecided", "X",
              "exit with 1 where more than this part of a run's surface pixels is undecided, as in 0.01"});
  add_option(compare_command,
             {"json", "FILE", "write the results there too; - means standard output, instead of the table"});
  compare_command.add_flag(
      "--debug", options.debug,
      "also write pictures of what a volume method holds; of vsv: the grid before and after "
      "the scan, and the shadowed samples and the changes of visibility of each pixel");

  add_tev(compare_command, options);

  CLI::App& sweep_command = add_image_command(
      app, options, "sweep",
      "measures every setting of lists of values, one line of JSON each, as DIR/runs.jsonl; "
      "goes on where it was interrupted");
  sweep_command.add_option("-o", options.output, "folder for the runs (default: out/SCENE)")
      ->type_name("DIR");
  add_option(sweep_command,
             {"volume", "LIST",
              "methods of airlight, separated by commas; values in braces give each of them, as in "
              "vsv:alpha={64,128}:phi={128,256}. So do --surface and --shadow-map {512,1024}"});
  add_option(sweep_command,
             {"surface", "LIST", "methods of surface shadow, separated by commas (default: shadow-map)"});
  add_option(sweep_command, {"axes", "FILE.toml", "a file of these lists: see quality/axes.h"});
  sweep_command.add_flag("--all", options.all,
                         "every method of airlight that is judged, with up to 40 settings made of the values "
                         "that it calls worth sweeping");
  add_option(sweep_command,
             {"baseline", "METHOD",
              "whose frames are timed beside each setting's, with the first shadow map (default: vsv)"});
  add_option(
      sweep_command,
      {"frames", "N",
       "rounds: frames timed a setting, along a path plays of it (default: 9); of less than 6 there is "
       "no interval"});
  add_option(sweep_command,
             {"shard", "K/N", "only a part of the settings, from 1/N to N/N, in DIR/runs-K-of-N.jsonl"});
  render_command.footer(quality::method_help());
  view_command.footer(quality::method_help());
  sweep_command.footer(quality::method_help());
  compare_command.footer(quality::method_help());

  CLI::App& tune_command = add_image_command(
      app, options, "tune",
      "finds the setting that reaches a goal with the least: a command, a shot's lines, constants");
  add_option(tune_command,
             {"max-error", "X", "goal: the least time with a same-surface rrmse not above X, as in 0.01"});
  add_option(tune_command, {"max-ms", "T", "goal: the least error with frames of not more than T ms"});
  add_option(tune_command,
             {"max-bytes", "B", "goal: the least error with not more than B bytes of GPU memory"});
  add_option(tune_command, {"volume", "LIST",
                            "methods of airlight to choose from, separated by commas, with values in braces "
                            "as of sweep (default: all that "
                            "are judged, with the values that they call worth sweeping)"});
  add_option(tune_command, {"surface", "METHOD", "surface shadow (default: shadow-map)"});
  add_option(tune_command, {"frames", "N", "frames timed of those that are nearly the best (default: 7)"});
  add_option(tune_command, {"json", "FILE",
                            "write what was found there too; - means standard output, instead of the text"});
  tune_command.add_flag("--explain", options.explain, "also say what each knob of what was found is worth");
  tune_command.footer(quality::method_help());

  CLI::App& front_command = *app.add_subcommand(
      "front", "for each error the cheapest method and setting of what sweep has measured");
  front_command.add_option("DIR", options.places, "folders that sweep has written, or .jsonl files")
      ->type_name("");
  add_option(front_command,
             {"json", "FILE", "write the fronts there too; - means standard output, instead of the tables"});
  add_option(front_command, {"error", "NAME",
                             "what says how far a run is from the truth: rrmse (default: of pixels that see "
                             "the same surface as the truth), p99, flip, flicker"});

  CLI::App& report_command = *app.add_subcommand(
      "report", "joins what compare and sweep have written, shards too, in one page that needs nothing else");
  report_command
      .add_option(
          "DIR", options.places,
          "folders that compare or sweep has written, or results.json and .jsonl files, of one scene and "
          "view. Of a run that is there several times on one device the first one's figures count")
      ->type_name("");
  report_command.add_option("-o", options.output, "the page")->type_name("FILE.html");
  add_option(
      report_command,
      {"images", "N",
       "images that the page holds whole, the truth's included (default: 8); of others it holds crops"});
  report_command.add_flag("--quiet", options.quiet, "say nothing but errors");

  CLI::App& image_command = *app.add_subcommand(
      "image", "metrics of OpenEXR images, whoever rendered them: diff, error, flip, info or crop");
  image_command
      .add_option("FILE", options.places,
                  "what is asked and of which images:\n"
                  "diff A.exr B.exr -o FILE.exr   A - B, channel by channel, and as a heat map beside it\n"
                  "error A.exr B.exr              how far A is from B\n"
                  "flip A.exr B.exr               the mean of FLIP; -o FILE.png is its map\n"
                  "info A.exr                     size, metadata, and the range of each channel\n"
                  "crop A.exr -o FILE.exr         the part of --crop")
      ->type_name("");
  image_command.add_option("-o", options.output, "the image that is written")->type_name("FILE");
  add_option(image_command, {"layer", "NAME",
                             "of diff, error, flip: NAME.R, NAME.G, NAME.B, as in airlight "
                             "(default: R, G, B)"});
  add_option(image_command, {"exposure", "E", "of flip: LDR-FLIP at this exposure, instead of HDR-FLIP"});
  add_option(image_command,
             {"crop", "X,Y,W,H", "of crop: the corner at the top left, and the size [pixels]"});
  add_option(image_command,
             {"json", "FILE", "of error: write it there too; - means standard output, instead of the lines"});

  CLI::App& scenes_command = *app.add_subcommand("scenes", "lists the built-in scenes");
  CLI::App& info_command =
      *app.add_subcommand("info", "tells what a scene holds, or without one the driver and its limits");
  info_command
      .add_option("SCENE", options.scene, "a built-in scene's name, a shot (.toml), or a model's file")
      ->type_name("");
  add_option(info_command, {"triangles", "N", "of a built-in scene whose number of them can be set"});

  try {
    options.given = read_words(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help or version
    throw Error(ExitCode::usage, "command line", error.what(), "see airlight --help");
  }

  const auto require_scene = [&](const char* example) {
    if (options.scene.empty())
      throw Error(ExitCode::usage, "SCENE", "it is missing", fmt::format("name one, as in {}", example));
  };
  if (render_command.parsed()) {
    require_scene("airlight render window -o out.exr");
    render(options);
  } else if (view_command.parsed()) {
    if (options.scene.empty()) options.scene = k_viewed_scene;
    view(options);
  } else if (compare_command.parsed()) {
    if (options.scene.empty()) options.scene = k_compared_scene;
    compare(options);
  } else if (sweep_command.parsed()) {
    require_scene("airlight sweep window --all -o out/sweep");
    sweep(options);
  } else if (tune_command.parsed()) {
    require_scene("airlight tune window --max-error 0.01");
    tune(options);
  } else if (front_command.parsed()) {
    front(options);
  } else if (report_command.parsed()) {
    report(options);
  } else if (image_command.parsed()) {
    image(options);
  } else if (scenes_command.parsed()) {
    list_scenes();
  } else if (info_command.parsed()) {
    info(options);
  }
  return 0;
}

}  // namespace
}  // namespace airlight::app

int main(int argc, char** argv) {
  using airlight::scene::ExitCode;
  const auto fail = [](const std::string& message, ExitCode code) {
    airlight::app::say("airlight: " + message);
    return static_cast<int>(code);
  };
  try {
    return airlight::app::run(argc, argv);
  } catch (const airlight::scene::Error& error) {
    return fail(error.what(), error.exit_code);
  } catch (const std::bad_alloc&) {
    return fail("memory: there is not enough; ask for a smaller image or grid", ExitCode::driver);
  } catch (const std::exception& error) {
    return fail(fmt::format("{}; this is a fault of the program: please report the command", error.what()),
                ExitCode::driver);
  }
}
