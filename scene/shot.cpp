#include "scene/shot.h"

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "scene/builtin.h"
#include "scene/choices.h"
#include "scene/import.h"
#include "scene/import_internal.h"
#include "scene/toml_table.h"

namespace airlight::scene {
namespace {

/// The choices of a shot, all of which are read before its scene is.
class ShotChoices : public Choices {
 public:
  ShotChoices(const std::filesystem::path& file, const toml::table& content,
              const LightTextureReader& reader) {
    tables_.emplace("", Table(file, content));
    for (const FieldInfo* field : every_field()) {
      if (field->kind == FieldKind::size) continue;  // the image's, which a shot leaves open
      if (!tables_.contains(field->group)) tables_.emplace(field->group, root().table(field->group));
      if (auto value = table_of(*field).value(*field, reader)) add(*field, std::move(*value));
    }
    if (root().has("light") && root().has("sun"))
      throw root().error("sun", "[light] contradicts it", "give one or the other");
  }

  Table& root() { return tables_.at(""); }

  /// Refuses keys that nobody asked for.
  void refuse_others() const {
    for (const auto& [name, table] : tables_) table.refuse_others();
  }

  std::string spell(const FieldInfo& field) const override { return field.key(); }
  Error error(const FieldInfo& field, const std::string& problem, const std::string& remedy) const override {
    return tables_.at(field.group).error(field.key(), problem, remedy);
  }

 private:
  Table& table_of(const FieldInfo& field) { return tables_.at(field.group); }

  std::map<std::string_view, Table> tables_;
};

/// The scene that the shot shows, as it comes.
Scene load_subject(const std::filesystem::path& file, ShotChoices& choices,
                   std::optional<std::size_t> triangles) {
  Table& shot = choices.root();
  const auto name = shot.text("scene");
  const auto own_triangles = shot.count("triangles");
  if (!name) throw file_error(file, "", "it names no scene", "begin it with scene = \"NAME\"");
  if (name->find('\0') != name->npos) throw shot.error("scene", "it is no name of a file");

  // Said before a long model is read.
  choices.refuse_others();
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
  const toml::table root = read_toml(file);
  ShotChoices choices(file, root, read_light_texture);
  Scene scene = load_subject(file, choices, triangles);
  choose_all(choices, scene);
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
