#include "app/options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "quality/light_texture.h"
#include "quality/numbers.h"
#include "quality/results.h"
#include "scene/builtin.h"
#include "scene/error.h"
#include "scene/import.h"
#include "scene/shot.h"

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

scene::Scene load_scene(const Options& options) {
  const std::string& name = options.scene;
  const std::filesystem::path file(name);
  const scene::BuiltinScene* builtin = scene::find_builtin(name);
  std::optional<std::size_t> triangles;
  if (const auto text = options.get("triangles")) {
    triangles = static_cast<std::size_t>(quality::parse_count("--triangles", *text));
    // A shot knows itself what it shows.
    const std::string problem = is_shot(file) ? "" : scene::count_problem(builtin, name, *triangles);
    if (!problem.empty()) throw usage("--triangles", problem);
  }
  if (builtin) return builtin->make(triangles);
  if (is_shot(file)) return scene::load_shot(file, triangles);
  if (std::error_code error; !file.has_extension() && !std::filesystem::exists(file, error)) {
    throw Error(ExitCode::bad_file, name, "there is no such scene", scene_help());
  }
  return scene::import_scene(file);
}

/// One of the named things that a scene brings, by name or by number from 0.
template <typename Thing>
const Thing& pick(const std::string& option, const std::string& choice, const std::vector<Thing>& things) {
  for (const Thing& thing : things) {
    if (thing.name == choice) return thing;
  }
  const bool is_number =
      !choice.empty() && choice.size() < 9 &&
      std::all_of(choice.begin(), choice.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (is_number && std::stoul(choice) < things.size()) return things[std::stoul(choice)];

  std::string names;
  for (std::size_t i = 0; i < things.size(); ++i) {
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", i,
                         things[i].name.empty() ? "no name" : things[i].name);
  }
  throw usage(option, fmt::format("the scene has no '{}'", choice),
              names.empty() ? "it has none" : "it has " + names);
}

scene::Camera choose_camera(const Options& options, const scene::Scene& scene) {
  const auto name = options.get("camera"), eye = options.get("eye"), target = options.get("target");
  if (eye.has_value() != target.has_value()) {
    throw usage(eye ? "--eye" : "--target", fmt::format("it needs {}", eye ? "--target" : "--eye"),
                "give both");
  }
  if (name && eye) throw usage("--camera", "--eye and --target contradict it", "give one or the other");

  scene::Camera camera;
  if (eye) {
    camera.name = "of --eye and --target";
    camera.eye = quality::parse_vector("--eye", *eye);
    camera.target = quality::parse_vector("--target", *target);
  } else if (name) {
    camera = pick("--camera", *name, scene.cameras);
  } else {
    camera = scene.cameras.empty() ? scene::fit_camera(scene.geometry) : scene.cameras[0];
  }
  if (const auto up = options.get("up")) camera.up = quality::parse_vector("--up", *up);
  if (const auto fov = options.get("fov")) {
    camera.vertical_fov_degrees = quality::parse_number("--fov", *fov);
    if (!(camera.vertical_fov_degrees > 0.0 && camera.vertical_fov_degrees < 180.0)) {
      throw usage("--fov", fmt::format("'{}' is not between 0 and 180 degrees", *fov));
    }
  }
  return camera;
}

scene::Light choose_light(const Options& options, const scene::Scene& scene) {
  const auto name = options.get("light"), position = options.get("light-position"),
             intensity = options.get("intensity");
  if (name && position) throw usage("--light", "--light-position contradicts it", "give one or the other");

  scene::Light light;
  if (position) {
    if (!intensity)
      throw usage("--light-position", "it needs --intensity", "give both, as in --intensity 10 [W/sr]");
    light.name = "of --light-position";
    light.position = quality::parse_vector("--light-position", *position);
  } else if (name) {
    light = pick("--light", *name, scene.lights);
  } else if (!scene.lights.empty()) {
    light = scene.lights[0];
  } else {
    throw usage(options.scene, "it has no light", "give one with --light-position x,y,z --intensity r,g,b");
  }
  if (intensity) light.intensity = quality::parse_colour("--intensity", *intensity);
  if (const auto texture = options.get("light-texture")) {
    light.texture = std::make_shared<const scene::LightTexture>(quality::read_light_texture(*texture));
  }
  return light;
}

scene::Medium choose_medium(const Options& options, scene::Medium medium) {
  if (const auto value = options.get("sigma-s")) medium.sigma_s = quality::parse_colour("--sigma-s", *value);
  if (const auto value = options.get("sigma-a")) medium.sigma_a = quality::parse_colour("--sigma-a", *value);
  if (const auto value = options.get("phase")) {
    medium.phase = scene::phase_of_name("--phase", *value);
    if (!scene::has_g(medium.phase)) medium.g = 0.0f;
  }
  if (const auto value = options.get("g")) {
    medium.g = quality::parse_float("--g", *value);
    if (!(medium.g > -1.0f && medium.g < 1.0f))
      throw usage("--g", fmt::format("'{}' is not between -1 and 1", *value));
    if (!scene::has_g(medium.phase)) {
      throw usage("--g", fmt::format("the phase function {} has no g", scene::phase_name(medium.phase)),
                  "give --phase henyey-greenstein or hoffman-preetham");
    }
  }
  if (const auto value = options.get("rayleigh-weight")) {
    medium.rayleigh_weight = quality::parse_float("--rayleigh-weight", *value);
    if (!(medium.rayleigh_weight >= 0.0f && medium.rayleigh_weight <= 1.0f))
      throw usage("--rayleigh-weight", fmt::format("'{}' is not between 0 and 1", *value));
    if (medium.phase != scene::PhaseFunction::hoffman_preetham) {
      throw usage("--rayleigh-weight",
                  fmt::format("the phase function {} mixes nothing", scene::phase_name(medium.phase)),
                  "give --phase hoffman-preetham");
    }
  }
  return medium;
}

/// --albedo
glm::vec3 parse_albedo(const std::string& text) {
  const glm::vec3 albedo = quality::parse_colour("--albedo", text);
  if (std::max({albedo.x, albedo.y, albedo.z}) > 1.0f) {
    throw usage("--albedo", fmt::format("'{}' is more than 1", text), "a surface reflects at most all light");
  }
  return albedo;
}

}  // namespace

std::span<const OptionLine> common_options() {
  static const std::vector<OptionLine> options = [] {
    std::vector<OptionLine> lines = {
        {"triangles", "N", triangles_help()},
        {"camera", "NAME|N",
         "one of the scene's cameras, by name or number from 0 (default: the first; without one, the view is "
         "fitted)"},
        {"eye", "X,Y,Z", "where the camera stands [m]; needs --target"},
        {"target", "X,Y,Z", "a point straight ahead of the camera [m]; needs --eye"},
        {"up", "X,Y,Z", "the camera's up (default: 0,1,0 with --eye, else the camera's own)"},
        {"fov", "DEG", "vertical field of view (default: 45 with --eye, else the camera's own)"},
        {"light", "NAME|N", "one of the scene's lights, by name or number from 0 (default: the first)"},
        {"light-position", "X,Y,Z", "where the light is [m]; needs --intensity"},
        {"intensity", "R,G,B", "radiant intensity of the light [W/sr]; one number means grey"},
        {"light-texture", "FILE.exr",
         "what the light radiates by direction, relative to its intensity: an equirectangular image, +Y at "
         "the "
         "top, +Z in the middle, +X to the left of it; for vsv it needs integral=riemann"},
        {"sigma-s", "R,G,B",
         "scattering coefficient [1/m]; one number means grey (default: the scene's, 0.1 for a file)"},
        {"sigma-a", "R,G,B",
         "absorption coefficient [1/m]; one number means grey (default: the scene's, 0 for a file)"},
        {"phase", "NAME",
         "phase function: isotropic, rayleigh, henyey-greenstein, hoffman-preetham (default: the scene's, "
         "isotropic for a file)"},
        {"g", "G", "mean cosine of henyey-greenstein, between -1 and 1"},
        {"rayleigh-weight", "W",
         "part of rayleigh in hoffman-preetham, 0 to 1; the rest is henyey-greenstein (default: 0.5)"},
        {"albedo", "R,G,B", "reflectance of every surface, 0 to 1; 0 leaves the airlight alone"},
        {"size", "WxH", "size of the image [pixels] (default: 512x512)"},
        {"exposure", "E",
         "of PNG images: radiance is multiplied by it (default: the scene's; for a file, the 95th percentile "
         "maps to 0.8)"},
        {"shadow-map", "N", "side of a face of the shadow map [texels] (default: 2048)"},
        {"reference-samples", "N",
         "of the reference: uniform steps in the light angle that look for changes of visibility (default: "
         "512)"},
        {"cache", "DIR", "keep the reference's images there, and look there before tracing them"},
    };
    for (const quality::CommonOptionText& text : quality::common_option_texts())
      lines.push_back({text.name, "VALUE", text.help});
    return lines;
  }();
  return options;
}

std::string Options::command_line(std::span<const std::string_view> without) const {
  std::string line = fmt::format("airlight {} {}", command, quality::shell_quote(scene));
  for (const auto& [name, value] : given) {
    if (std::find(without.begin(), without.end(), name) != without.end()) continue;
    line += fmt::format(" --{} {}", name, quality::shell_quote(value));
  }
  if (debug) line += " --debug";
  return line;
}

Subject make_subject(const Options& options) {
  // What is wrong with the words is said before a long file is read.
  const glm::ivec2 size = quality::parse_size("--size", options.get("size").value_or("512x512"));
  std::optional<float> exposure;
  if (const auto text = options.get("exposure")) {
    exposure = quality::parse_float("--exposure", *text);
    if (*exposure <= 0.0f) throw usage("--exposure", fmt::format("'{}' is not positive", *text));
  }

  Subject subject{load_scene(options), {}, exposure};
  if (!exposure) subject.exposure = subject.scene.exposure;
  subject.view = {choose_camera(options, subject.scene),
                  {choose_light(options, subject.scene)},
                  choose_medium(options, subject.scene.medium),
                  size};
  if (const auto text = options.get("albedo"))
    scene::override_albedo(subject.scene.geometry, parse_albedo(*text));
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
  add("reference-samples", "samples");
  for (const quality::CommonOption& option : common) quality::require_valid(option);
  return common;
}

int reference_samples(const Options& options) {
  return quality::parse_count("--reference-samples", options.get("reference-samples").value_or("512"));
}

std::vector<quality::VolumeChoice> parse_volumes(const Options& options, std::string_view usual) {
  return quality::parse_volumes(options.get("volume").value_or(std::string(usual)),
                                common_method_options(options));
}

std::vector<quality::SurfaceChoice> parse_surfaces(const Options& options) {
  return quality::parse_surfaces(options.get("surface").value_or("shadow-map"),
                                 common_method_options(options));
}

void fit_to_view(const Options& options, std::vector<quality::VolumeChoice>& volumes,
                 std::vector<quality::SurfaceChoice>& surfaces, Subject& subject) {
  // A usual method's options are not the user's choice, but for those that the command gives.
  std::erase_if(volumes, [&](const quality::VolumeChoice& volume) {
    const auto refusal = volume.method->refusal(volume.options, subject.view);
    return refusal && !options.get("volume") &&
           !options.get(refusal->where.substr(0, refusal->where.find('=')));
  });
  for (quality::VolumeChoice& volume : volumes) volume.fit(subject.view);
  for (quality::SurfaceChoice& surface : surfaces) surface.fit(subject.view);
  quality::warn_of_open_parts(volumes, surfaces, subject.scene);
}

int shadow_map_size(const Options& options) {
  return quality::parse_count("--shadow-map", options.get("shadow-map").value_or("2048"));
}

}  // namespace airlight::app
