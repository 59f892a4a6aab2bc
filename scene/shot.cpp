#include "scene/shot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/builtin.h"
#include "scene/import.h"
#include "scene/import_internal.h"

namespace airlight::scene {
namespace {

std::string line_of(const toml::source_region& source) {
  return fmt::format("line {}", source.begin.line);
}

/// A table of the file. Each key that is asked for is known; `refuse_others` refuses what is left.
class Table {
 public:
  /// @param name as it stands in the file; empty for the file's own
  Table(const std::filesystem::path& file, const toml::table& table, std::string name)
      : file_(file), table_(table), name_(std::move(name)) {}

  bool has(std::string_view key) const { return table_.contains(key); }

  Error error(std::string_view key, const std::string& problem, const std::string& remedy = {}) const {
    const toml::node* node = table_.get(key);
    const std::string place = line_of(node ? node->source() : table_.source());
    return file_error(file_, fmt::format("{}, {}{}{}", place, name_, name_.empty() ? "" : ".", key), problem,
                      remedy);
  }

  std::optional<std::string> text(std::string_view key) {
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    if (!node->is_string()) throw error(key, "it must be a text in quotes");
    return node->value<std::string>();
  }

  std::optional<double> number(std::string_view key) {
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    return number_of(key, *node, "it must be a number");
  }

  std::optional<std::size_t> count(std::string_view key) {
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < 1) throw error(key, "it must be a whole number, at least 1");
    return static_cast<std::size_t>(*value);
  }

  std::optional<glm::dvec3> vector(std::string_view key) {
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    return vector_of(key, *node, "it must be three numbers, as in [0, 1, 0]");
  }

  /// Three numbers or one that stands for all; none negative, and each fits a float.
  std::optional<glm::vec3> colour(std::string_view key) {
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    constexpr const char* k_wanted = "it must be a number or three, as in [1, 0.8, 0.6]";
    const glm::dvec3 value =
        node->is_number() ? glm::dvec3(number_of(key, *node, k_wanted)) : vector_of(key, *node, k_wanted);
    if (std::min({value.x, value.y, value.z}) < 0.0) throw error(key, "it must not be negative");
    if (std::max({value.x, value.y, value.z}) > static_cast<double>(std::numeric_limits<float>::max()))
      throw error(key, "it is too large");
    return glm::vec3(value);
  }

  Table table(std::string_view key) {
    static const toml::table k_empty;
    const toml::node* node = find(key);
    if (node && !node->is_table()) throw error(key, fmt::format("it must be a table, begun by [{}]", key));
    return {file_, node ? *node->as_table() : k_empty, std::string(key)};
  }

  void refuse_others() const {
    for (const auto& [key, value] : table_) {
      if (known_.contains(key.str())) continue;
      std::string names;
      for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
      throw file_error(file_, line_of(key.source()),
                       fmt::format("there is no key '{}'{}", printable(key.str()),
                                   name_.empty() ? "" : fmt::format(" in [{}]", name_)),
                       "use " + names);
    }
  }

 private:
  const toml::node* find(std::string_view key) {
    known_.emplace(key);
    return table_.get(key);
  }

  double number_of(std::string_view key, const toml::node& node, const char* wanted) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) throw error(key, wanted);
    if (!std::isfinite(*value)) throw error(key, fmt::format("{} is not finite", *value));
    return *value;
  }

  glm::dvec3 vector_of(std::string_view key, const toml::node& node, const char* wanted) const {
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) throw error(key, wanted);
    glm::dvec3 value;
    for (int i = 0; i < 3; ++i) value[i] = number_of(key, (*array)[static_cast<std::size_t>(i)], wanted);
    return value;
  }

  const std::filesystem::path& file_;
  const toml::table& table_;
  std::string name_;
  std::set<std::string, std::less<>> known_;
};

/// The scene that the shot shows, as it comes.
Scene load_subject(const std::filesystem::path& file, Table& shot, std::optional<std::size_t> triangles) {
  const auto name = shot.text("scene");
  const auto own_triangles = shot.count("triangles");
  if (!name) throw file_error(file, "", "it names no scene", "begin it with scene = \"NAME\"");
  if (name->find('\0') != name->npos) throw shot.error("scene", "it is no name of a file");

  // Said before a long model is read.
  shot.refuse_others();
  const BuiltinScene* builtin = find_builtin(*name);
  if (triangles) {
    const std::string problem = count_problem(builtin, *name, *triangles);
    if (!problem.empty()) throw Error(ExitCode::usage, "--triangles", problem);
  } else if (own_triangles) {
    const std::string problem = count_problem(builtin, *name, *own_triangles);
    if (!problem.empty()) throw shot.error("triangles", problem);
  }
  if (builtin) return builtin->make(triangles ? triangles : own_triangles);
  try {
    return import_scene(file.parent_path() / *name);
  } catch (const Error& error) {
    throw shot.error("scene", error.what());
  }
}

/// Puts the thing of that name first. @throws Error that names the others
template <typename Thing>
void put_first(const Table& table, const std::string& name, std::vector<Thing>& things) {
  const auto found =
      std::find_if(things.begin(), things.end(), [&](const Thing& thing) { return thing.name == name; });
  if (found == things.end()) {
    std::string names;
    for (const Thing& thing : things)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", printable(thing.name));
    throw table.error("name", fmt::format("the scene has no '{}'", printable(name)),
                      names.empty() ? "it has none" : "it has " + names);
  }
  std::rotate(things.begin(), found, found + 1);
}

void choose_camera(Table& table, Scene& scene) {
  const auto name = table.text("name");
  const auto eye = table.vector("eye"), target = table.vector("target"), up = table.vector("up");
  const auto fov = table.number("fov");
  table.refuse_others();
  if (eye.has_value() != target.has_value())
    throw table.error(eye ? "eye" : "target", fmt::format("it needs {}", eye ? "target" : "eye"),
                      "give both");
  if (name && eye) throw table.error("name", "eye and target contradict it", "give one or the other");

  if (eye) {
    Camera camera;
    camera.name = "shot";
    camera.eye = *eye;
    camera.target = *target;
    scene.cameras.insert(scene.cameras.begin(), camera);
  } else if (name) {
    put_first(table, *name, scene.cameras);
  } else if (scene.cameras.empty()) {
    scene.cameras.push_back(fit_camera(scene.geometry));
  }
  if (up) scene.cameras[0].up = *up;
  if (fov) {
    if (!(*fov > 0.0 && *fov < 180.0))
      throw table.error("fov", fmt::format("{} is not between 0 and 180 degrees", *fov));
    scene.cameras[0].vertical_fov_degrees = *fov;
  }
}

void choose_light(Table& table, Scene& scene) {
  const auto name = table.text("name");
  const auto position = table.vector("position");
  const auto intensity = table.colour("intensity");
  table.refuse_others();
  if (name && position) throw table.error("name", "position contradicts it", "give one or the other");

  if (position) {
    if (!intensity)
      throw table.error("position", "it needs intensity", "give both, as in intensity = 10 [W/sr]");
    scene.lights.insert(scene.lights.begin(), point_light("shot", *position, *intensity));
  } else if (name) {
    put_first(table, *name, scene.lights);
  } else if (intensity && scene.lights.empty()) {
    throw table.error("intensity", "the scene has no light", "give its position, too");
  }
  if (intensity) scene.lights[0].intensity = *intensity;
}

void choose_medium(Table& table, Medium& medium) {
  if (const auto value = table.colour("sigma_s")) medium.sigma_s = *value;
  if (const auto value = table.colour("sigma_a")) medium.sigma_a = *value;
  if (const auto value = table.text("phase")) {
    try {
      medium.phase = phase_of_name("phase", *value);
    } catch (const Error& error) {
      throw table.error("phase", printable(error.what()));
    }
    if (!has_g(medium.phase)) medium.g = 0.0f;
  }
  if (const auto value = table.number("g")) {
    medium.g = static_cast<float>(*value);
    if (!(std::abs(medium.g) < 1.0f))
      throw table.error("g", fmt::format("{} is not between -1 and 1", *value));
    if (!has_g(medium.phase)) {
      throw table.error("g", fmt::format("the phase function {} has no g", phase_name(medium.phase)),
                        "give phase = \"henyey-greenstein\"");
    }
  }
  if (const auto value = table.number("rayleigh_weight")) {
    medium.rayleigh_weight = static_cast<float>(*value);
    if (!(*value >= 0.0 && *value <= 1.0))
      throw table.error("rayleigh_weight", fmt::format("{} is not between 0 and 1", *value));
    if (medium.phase != PhaseFunction::hoffman_preetham) {
      throw table.error("rayleigh_weight",
                        fmt::format("the phase function {} mixes nothing", phase_name(medium.phase)),
                        "give phase = \"hoffman-preetham\"");
    }
  }
  table.refuse_others();
}

}  // namespace

Scene load_shot(const std::filesystem::path& file, std::optional<std::size_t> triangles) {
  const std::string text = read_file(file);
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw file_error(file, line_of(error.source()), printable(error.description()));
  }

  Table shot(file, root, "");
  Table camera = shot.table("camera"), light = shot.table("light"), medium = shot.table("medium");
  const auto exposure = shot.number("exposure");
  const auto albedo = shot.colour("albedo");
  if (exposure && !(static_cast<float>(*exposure) > 0.0f && std::isfinite(static_cast<float>(*exposure))))
    throw shot.error("exposure", fmt::format("{} is not positive", *exposure));
  if (albedo && std::max({albedo->x, albedo->y, albedo->z}) > 1.0f)
    throw shot.error("albedo", "it is more than 1", "a surface reflects at most all light");

  Scene scene = load_subject(file, shot, triangles);
  choose_camera(camera, scene);
  choose_light(light, scene);
  choose_medium(medium, scene.medium);
  if (exposure) scene.exposure = static_cast<float>(*exposure);
  if (albedo) override_albedo(scene.geometry, *albedo);
  try {
    if (scene.lights.empty())
      camera_frame(scene.cameras[0], {1, 1});
    else
      validate({scene.cameras[0], {scene.lights[0]}, scene.medium, {1, 1}});
  } catch (const Error& error) {
    throw file_error(file, "", error.what());
  }
  scene.name = file.stem().string();
  return scene;
}

}  // namespace airlight::scene
