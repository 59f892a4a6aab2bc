#include "app/options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "app/memory.h"
#include "frame/option.h"
#include "quality/light_texture.h"
#include "quality/results.h"
#include "scene/builtin.h"
#include "scene/choices.h"
#include "scene/error.h"
#include "scene/fitted_ambient.h"
#include "scene/import.h"
#include "scene/numbers.h"
#include "scene/shot.h"
#include "scene/transmission.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

Error usage(const std::string& where, const std::string& problem, const std::string& remedy = {}) {
  return Error(ExitCode::usage, where, problem, remedy);
}

/// The file formats and built-in scenes that SCENE can name.
std::string scene_help() {
  std::string names;
  for (const scene::BuiltinScene& builtin : scene::builtin_scenes()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", builtin.name);
  }
  return fmt::format("use a built-in scene ({}), a shot (.toml) or a .gltf, .glb, .obj or .ply file", names);
}

std::string triangles_help() {
  std::string scenes;
  for (const scene::BuiltinScene& builtin : scene::builtin_scenes()) {
    if (!builtin.count) continue;
    scenes += fmt::format("; {}: at least {}, rounded {} (default: {})", builtin.name, builtin.count->fewest,
                          builtin.count->rounding, builtin.count->usual);
  }
  return "about how many triangles the built-in scene has" + scenes;
}

bool is_shot(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".toml";
}

/// What the model looks like. Where methods are compared their times are, too: unless asked otherwise,
/// nothing is drawn there that none of them computes.
scene::Looks looks(const Options& options) {
  const std::string text = options.get("looks").value_or(
      options.command == "render" || options.command == "view" ? "textured" : "flat");
  return static_cast<scene::Looks>(frame::parse_word("--looks", text, {{"flat"}, {"textured"}}));
}

/// What light passes.
scene::Transmission transmission(const Options& options) {
  frame::Words words;
  for (const std::string_view name : scene::transmission_names()) words.push_back({name});
  return static_cast<scene::Transmission>(
      frame::parse_word("--occluders", options.get("occluders").value_or("material"), words));
}

/// Of --ambient.
constexpr std::string_view k_fitted = "auto";

class OptionChoices final : public scene::Choices {
 public:
  std::string spell(const scene::FieldInfo& field) const override { return fmt::format("--{}", field.name); }
  Error error(const scene::FieldInfo& field, const std::string& problem,
              const std::string& remedy) const override {
    return usage(spell(field), problem, remedy);
  }
};

/// The choices of a command line, all of which are read before a scene is.
struct ViewChoices {
  OptionChoices of_view;  ///< all that is no light's
  std::vector<std::unique_ptr<const scene::Choices>> of_lights;
};

ViewChoices read_choices(const Options& options) {
  ViewChoices choices;
  // What stands before the first light is a light's of its own, or of the only one that follows.
  std::vector<std::unique_ptr<OptionChoices>> lights;
  const scene::FieldInfo* before_lights = nullptr;
  std::size_t named = 0;
  for (const auto& [name, text] : options.given) {
    const scene::FieldInfo* field = scene::find_field(name);
    if (!field || (name == "ambient" && text == k_fitted)) continue;
    OptionChoices* of_field = &choices.of_view;
    if (scene::is_of_light(*field)) {
      const bool begins = scene::names_light(*field) && (named++ > 0 || lights.empty());
      if (begins || lights.empty()) lights.push_back(std::make_unique<OptionChoices>());
      if (named == 0 && !before_lights) before_lights = field;
      of_field = lights.back().get();
    }
    if (of_field->get(*field)) throw usage(of_field->spell(*field), "it is given twice", "give it once");
    of_field->add(*field, value_of_text(*field, of_field->spell(*field), text, quality::read_light_texture));
  }
  if (named > 1 && before_lights)
    throw usage(
        choices.of_view.spell(*before_lights), "it stands before the lights, and is none's",
        "let it follow the option that begins its light: --light, --light-position, --sun or --sun-angles");
  for (auto& light : lights) choices.of_lights.push_back(std::move(light));
  return choices;
}

}  // namespace

std::span<const OptionLine> common_options() {
  static const std::vector<OptionLine> options = [] {
    std::vector<OptionLine> lines = {
        {"triangles", "N", triangles_help()},
        {"looks", "flat|textured",
         "what a model's surfaces look like: one colour a material and flat "
         "triangles, or the textures of base colours, what masks cut out, and shading "
         "normals; but for cut-outs, shadows and airlight are the same (default: textured "
         "in render and view, else flat)"}};
    lines.push_back({"occluders", "material|opaque|x-ray|x-ray-coloured",
                     "what light passes: what the materials let through, nothing, or every triangle by a "
                     "share that falls with the angle of incidence (default: material)"});
    for (const scene::FieldInfo* field : scene::every_field())
      lines.push_back({field->name, field->placeholder, field->help()});
    lines.push_back(
        {"path", "FILE.toml",
         "images along a path of camera, lights and glTF nodes, whose key frames the file holds"});
    lines.push_back({"shadow-map", "N", "side of a face of the shadow map [texels] (default: 2048)"});
    lines.push_back({"cache", "DIR",
                     "keep the reference's images and the clusters of metric-tree there, and look there "
                     "before making them"});
    for (const quality::CommonOptionText& text : quality::common_option_texts())
      lines.push_back({text.name, "VALUE", text.help});
    return lines;
  }();
  return options;
}

std::string Options::command_line(std::span<const std::string> without) const {
  std::string line = fmt::format("airlight {} {}", command, quality::shell_quote(scene));
  for (const auto& [name, value] : given) {
    if (std::find(without.begin(), without.end(), name) != without.end()) continue;
    line += fmt::format(" --{} {}", name, quality::shell_quote(value));
  }
  if (debug) line += " --debug";
  return line;
}

scene::Scene load_scene(const Options& options) {
  const std::string& name = options.scene;
  const std::filesystem::path file(name);
  const scene::Looks shown = looks(options);
  const scene::BuiltinScene* builtin = scene::find_builtin(name);
  std::optional<std::size_t> triangles;
  if (const auto text = options.get("triangles")) {
    triangles = static_cast<std::size_t>(scene::parse_count("--triangles", *text));
    // A shot knows itself what it shows.
    const std::string problem = is_shot(file) ? "" : scene::count_problem(builtin, name, *triangles);
    if (!problem.empty()) throw usage("--triangles", problem);
  }
  if (builtin) return builtin->make(triangles, shown);
  if (is_shot(file)) return scene::load_shot(file, triangles, quality::read_light_texture, shown);
  if (std::error_code error; !file.has_extension() && !std::filesystem::exists(file, error)) {
    throw Error(ExitCode::bad_file, name, "there is no such scene", scene_help());
  }
  return scene::import_scene(file, shown);
}

Subject make_subject(const Options& options) {
  // What is wrong with the words is said before a long file is read.
  const ViewChoices choices = read_choices(options);
  const scene::Transmission passes = transmission(options);
  Subject subject{load_scene(options), {}, {}, {}};
  subject.scene.geometry.transmission = passes;
  choose_all(choices.of_view, choices.of_lights, subject.scene);
  if (subject.scene.lights.empty())
    throw usage(options.scene, "it has no light",
                "give one with --light-position x,y,z --intensity r,g,b or --sun x,y,z --irradiance r,g,b");
  subject.view = {subject.scene.cameras[0], subject.scene.lights, subject.scene.medium};
  choose(choices.of_view, subject.view);
  subject.view.surroundings = subject.scene.surroundings;
  glm::vec3& ambient = subject.view.surroundings.ambient;
  if (options.get("ambient") == std::string(k_fitted)) {
    ambient = scene::fitted_ambient(subject.scene.geometry, subject.view.lights, subject.view.medium);
  } else if (options.command == "view" && !options.get("ambient") && ambient == glm::vec3(0.0f) &&
             subject.scene.exposure) {
    // A window is to be looked at: what no light reaches is dim there, not black. What light there is may
    // lie outside of a room: no more than a part of what the exposure shows as white.
    constexpr float k_dim = 0.03f;
    ambient = scene::fitted_ambient(subject.scene.geometry, subject.view.lights, subject.view.medium);
    const float brightest = std::max({ambient.r, ambient.g, ambient.b, 1e-30f}) * *subject.scene.exposure;
    ambient *= std::min(1.0f, k_dim / brightest);
  }
  subject.exposure = subject.scene.exposure;
  if (const auto path = options.get("path")) {
    subject.path = scene::load_path(*path, subject.view, &subject.scene);
    subject.view = subject.path->views[0];
    for (const std::string& warning : subject.path->warnings)
      subject.scene.report.warnings.push_back(warning);
  }
  scene::validate(subject.view);
  return subject;
}

std::vector<quality::CommonOption> common_method_options(const Options& options) {
  std::vector<quality::CommonOption> common;
  const auto add = [&](const std::string& option, const std::string& name) {
    if (const auto text = options.get(option)) common.push_back({"--" + option, name, *text});
  };
  for (const quality::CommonOptionText& text : quality::common_option_texts())
    add(std::string(text.name), std::string(text.name));
  for (const quality::CommonOption& option : common) quality::require_valid(option);
  return common;
}

std::vector<quality::VolumeChoice> parse_volumes(const Options& options, std::string_view usual) {
  return quality::parse_volumes(options.get("volume").value_or(std::string(usual)),
                                common_method_options(options));
}

std::vector<quality::SurfaceChoice> parse_surfaces(const Options& options) {
  return quality::parse_surfaces(options.get("surface").value_or("shadow-map"),
                                 common_method_options(options));
}

void require_read(const Options& options, std::span<const quality::VolumeChoice> volumes,
                  std::span<const quality::SurfaceChoice> surfaces) {
  std::vector<std::string> given;
  for (const auto& option : options.given) given.push_back(option.first);
  quality::require_read(given, volumes, surfaces);
}

void take_usual_methods(const Options& options, const Subject& subject,
                        std::vector<quality::VolumeChoice>& volumes,
                        std::vector<quality::SurfaceChoice>& surfaces, int& shadow_map) {
  scene::UsualMethods usual = subject.scene.methods;
  if (scene::transmits(subject.scene.geometry)) {
    // Few rays, since each step asks a tree.
    if (usual.volume.empty())
      usual.volume = scene::transmits_by_incidence(subject.scene.geometry)
                         ? "none"
                         : "tree-march:where=epipolar:steps=64";
    if (usual.surface.empty()) usual.surface = "psv";
  }
  const std::vector<quality::CommonOption> common = common_method_options(options);
  if (!usual.volume.empty() && !options.get("volume")) volumes = quality::parse_volumes(usual.volume, common);
  if (!usual.surface.empty() && !options.get("surface"))
    surfaces = quality::parse_surfaces(usual.surface, common);
  if (usual.shadow_map && !options.get("shadow-map")) shadow_map = *usual.shadow_map;
  require_read(options, volumes, surfaces);
}

quality::AutomaticCounts fit_to_view(std::vector<quality::VolumeChoice>& volumes,
                                     std::vector<quality::SurfaceChoice>& surfaces, Subject& subject) {
  quality::AutomaticCounts automatic;
  for (const quality::VolumeChoice& volume : volumes) automatic.push_back(quality::automatic_counts(volume));
  for (quality::VolumeChoice& volume : volumes) volume.fit(subject.views());
  for (quality::SurfaceChoice& surface : surfaces) surface.fit(subject.views());
  quality::warn_of_geometry(volumes, surfaces, subject.scene);
  return automatic;
}

std::string command_of_pair(const Options& options, const quality::VolumeChoice& volume,
                            const quality::SurfaceChoice& surface, std::vector<std::string> without) {
  without.insert(without.end(), {"volume", "surface"});
  for (const auto& option : options.given)
    if (!quality::is_read(option.first, {&volume, 1}, {&surface, 1})) without.push_back(option.first);
  return fmt::format("{} --volume {} --surface {}", options.command_line(without),
                     quality::shell_quote(volume.spec), quality::shell_quote(surface.spec));
}

std::filesystem::path output_folder(const Options& options) {
  return options.output.empty() ? std::filesystem::path("out") / std::filesystem::path(options.scene).stem()
                                : std::filesystem::path(options.output);
}

std::size_t bytes_of_compare(const Subject& subject) {
  const std::size_t lights = subject.view.lights.size();
  return k_bytes_of_compare + k_bytes_of_compared_light * (lights - 1) +
         (subject.path ? subject.path->views.size() * lights * k_bytes_of_path_frame : 0);
}

int shadow_map_size(const Options& options) {
  return scene::parse_count("--shadow-map", options.get("shadow-map").value_or("2048"));
}

}  // namespace airlight::app
