#include "scene/shot.h"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/builtin.h"
#include "scene/choices.h"
#include "scene/import.h"
#include "scene/import_internal.h"
#include "scene/toml_table.h"

namespace airlight::scene {
namespace {

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
  UsualMethods methods;

  Shot(const std::filesystem::path& file, const toml::table& content, const LightTextureReader& reader)
      : root(std::make_shared<Table>(file, content)) {
    const auto table = [&](std::string_view key) { return std::make_shared<Table>(root->table(key)); };
    const auto add_light = [&](const std::shared_ptr<Table>& of_lamp, const std::shared_ptr<Table>& of_sun) {
      auto light =
          std::make_unique<ShotChoices>(ShotChoices::Tables{{"light", of_lamp}, {"sun", of_sun}}, reader);
      light->refuse_others();
      if (!light->is_empty()) lights.push_back(std::move(light));
    };
    const auto of_methods = table("methods");
    methods = {of_methods->text("volume").value_or(""), of_methods->text("surface").value_or(""), {}};
    if (const auto size = of_methods->count("shadow_map")) methods.shadow_map = static_cast<int>(*size);
    of_methods->refuse_others();
    choices = std::make_unique<ShotChoices>(
        ShotChoices::Tables{{"", root}, {"camera", table("camera")}, {"medium", table("medium")}}, reader);
    if (root->has("light") && root->has("sun"))
      throw root->error("sun", "[light] contradicts it", "give one or the other, or [[light]] for several");
    const std::vector<Table> several =
        content["light"].is_array() ? root->tables("light") : std::vector<Table>{};
    if (several.empty()) add_light(table("light"), table("sun"));
    for (const Table& one : several) {
      const auto shared = std::make_shared<Table>(one);
      add_light(shared, shared);
    }
  }
};

/// The scene that the shot shows, as it comes.
Scene load_subject(const std::filesystem::path& file, const Shot& whole, std::optional<std::size_t> triangles,
                   Looks looks) {
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
  if (builtin) return builtin->make(triangles ? triangles : own_triangles, looks);
  try {
    return import_scene(file.parent_path() / *name, looks);
  } catch (const Error& error) {
    throw shot.error("scene", error.what());
  }
}

}  // namespace

Scene load_shot(const std::filesystem::path& file, std::optional<std::size_t> triangles,
                const LightTextureReader& read_light_texture, Looks looks) {
  const toml::table root = read_toml(file);
  const Shot shot(file, root, read_light_texture);
  Scene scene = load_subject(file, shot, triangles, looks);
  choose_all(*shot.choices, shot.lights, scene);
  scene.methods = shot.methods;
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
