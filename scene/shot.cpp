#include "scene/shot.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/builtin.h"
#include "scene/choices.h"
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

  std::optional<std::size_t> count(std::string_view key) {
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < 1) throw error(key, "it must be a whole number, at least 1");
    return static_cast<std::size_t>(*value);
  }

  std::optional<FieldValue> value(const FieldInfo& field, const LightTextureReader& read_light_texture) {
    const std::string key = field.key();
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    switch (field.kind) {
      case FieldKind::number:
        return number_of(key, *node, "it must be a number");
      case FieldKind::vector:
      case FieldKind::direction:
        return vector_of<glm::dvec3>(key, *node, "it must be three numbers, as in [0, 1, 0]");
      case FieldKind::angles:
      case FieldKind::cone:
        return vector_of<glm::dvec2>(key, *node, "it must be two numbers, as in [30, 45]");
      case FieldKind::colour: {
        constexpr const char* k_wanted = "it must be a number or three, as in [1, 0.8, 0.6]";
        return node->is_number() ? glm::dvec3(number_of(key, *node, k_wanted))
                                 : vector_of<glm::dvec3>(key, *node, k_wanted);
      }
      case FieldKind::word:
        return *text(key);
      case FieldKind::file:
        return texture(key, *text(key), read_light_texture);
      case FieldKind::size:
        break;
    }
    return std::nullopt;
  }

  Table table(std::string_view key) {
    static const toml::table k_empty;
    const toml::node* node = find(key);
    if (node && !node->is_table()) throw error(key, fmt::format("it must be a table, begun by [{}]", key));
    return {file_, node ? *node->as_table() : k_empty, std::string(key)};
  }

  /// The tables of an array, each begun by [[key]]; none where there is none, or one table alone.
  std::vector<Table> tables(std::string_view key) {
    const toml::node* node = find(key);
    const toml::array* array = node ? node->as_array() : nullptr;
    std::vector<Table> tables;
    if (!array || array->empty() || !array->is_homogeneous(toml::node_type::table)) return tables;
    for (const toml::node& element : *array)
      tables.emplace_back(file_, *element.as_table(), std::string(key));
    return tables;
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
    return *value;
  }

  template <typename Vector>
  Vector vector_of(std::string_view key, const toml::node& node, const char* wanted) const {
    const toml::array* array = node.as_array();
    if (!array || array->size() != static_cast<std::size_t>(Vector::length())) throw error(key, wanted);
    Vector value;
    for (int i = 0; i < Vector::length(); ++i)
      value[i] = number_of(key, (*array)[static_cast<std::size_t>(i)], wanted);
    return value;
  }

  FieldValue texture(std::string_view key, const std::string& name, const LightTextureReader& read) const {
    if (!read) throw error(key, "there is nothing to read light textures with");
    if (name.find('\0') != name.npos) throw error(key, "it is no name of a file");
    try {
      return std::make_shared<const LightTexture>(read(file_.parent_path() / name));
    } catch (const Error& problem) {
      throw error(key, problem.what());
    }
  }

  const std::filesystem::path& file_;
  const toml::table& table_;
  std::string name_;
  std::set<std::string, std::less<>> known_;
};

/// The choices of a shot, or of one of its lights, all of which are read before its scene is.
class ShotChoices : public Choices {
 public:
  using Tables = std::map<std::string_view, std::shared_ptr<Table>>;

  /// @param tables where the fields of each group stand; those of other groups are not its own
  ShotChoices(Tables tables, const LightTextureReader& reader) : tables_(std::move(tables)) {
    for (const FieldInfo* field : every_field()) {
      if (field->kind == FieldKind::size) continue;  // the image's, which a shot leaves open
      const auto table = tables_.find(field->group);
      if (table == tables_.end() || are_angles_of_another(*field)) continue;
      if (auto value = table->second->value(*field, reader)) add(*field, std::move(*value));
    }
  }

  /// Refuses keys that nobody asked for.
  void refuse_others() const {
    for (const auto& [name, table] : tables_) table->refuse_others();
  }

  std::string spell(const FieldInfo& field) const override { return field.key(); }
  Error error(const FieldInfo& field, const std::string& problem, const std::string& remedy) const override {
    return tables_.at(field.group)->error(field.key(), problem, remedy);
  }

 private:
  /// In a table of [[light]], where keys of lamps and suns stand together, angles are a sun's beside its
  /// irradiance, else a spot's.
  bool are_angles_of_another(const FieldInfo& field) const {
    const auto lamp = tables_.find("light"), sun = tables_.find("sun");
    if (lamp == tables_.end() || sun == tables_.end() || lamp->second != sun->second) return false;
    const bool is_sun = sun->second->has(airlight::scene::field<Light>("irradiance").key());
    return (is_sun && field.name == "spot-angles") || (!is_sun && field.name == sun_angles().name);
  }

  Tables tables_;
};

/// A whole shot's.
struct Shot {
  std::shared_ptr<Table> root;
  std::unique_ptr<const ShotChoices> choices;
  std::vector<std::unique_ptr<const Choices>> lights;

  Shot(const std::filesystem::path& file, const toml::table& content, const LightTextureReader& reader)
      : root(std::make_shared<Table>(file, content, "")) {
    const auto table = [&](std::string_view key) { return std::make_shared<Table>(root->table(key)); };
    const auto add_light = [&](const std::shared_ptr<Table>& of_lamp, const std::shared_ptr<Table>& of_sun) {
      auto light =
          std::make_unique<ShotChoices>(ShotChoices::Tables{{"light", of_lamp}, {"sun", of_sun}}, reader);
      light->refuse_others();
      if (!light->is_empty()) lights.push_back(std::move(light));
    };
    choices = std::make_unique<ShotChoices>(
        ShotChoices::Tables{{"", root}, {"camera", table("camera")}, {"medium", table("medium")}}, reader);
    if (root->has("light") && root->has("sun"))
      throw root->error("sun", "[light] contradicts it", "give one or the other, or [[light]] for several");
    const std::vector<Table> several = root->tables("light");
    if (several.empty()) add_light(table("light"), table("sun"));
    for (const Table& one : several) {
      const auto shared = std::make_shared<Table>(one);
      add_light(shared, shared);
    }
  }
};

/// The scene that the shot shows, as it comes.
Scene load_subject(const std::filesystem::path& file, const Shot& whole,
                   std::optional<std::size_t> triangles) {
  Table& shot = *whole.root;
  const auto name = shot.text("scene");
  const auto own_triangles = shot.count("triangles");
  if (!name) throw file_error(file, "", "it names no scene", "begin it with scene = \"NAME\"");
  if (name->find('\0') != name->npos) throw shot.error("scene", "it is no name of a file");

  // Said before a long model is read.
  whole.choices->refuse_others();
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

}  // namespace

Scene load_shot(const std::filesystem::path& file, std::optional<std::size_t> triangles,
                const LightTextureReader& read_light_texture) {
  const std::string text = read_file(file);
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw file_error(file, line_of(error.source()), printable(error.description()));
  }

  const Shot shot(file, root, read_light_texture);
  Scene scene = load_subject(file, shot, triangles);
  choose_all(*shot.choices, shot.lights, scene);
  try {
    if (scene.lights.empty())
      camera_frame(scene.cameras[0], {1, 1});
    else
      validate({scene.cameras[0], scene.lights, scene.medium, {1, 1}});
  } catch (const Error& error) {
    throw file_error(file, "", error.what());
  }
  scene.name = file.stem().string();
  return scene;
}

}  // namespace airlight::scene
