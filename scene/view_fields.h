#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "scene/light_texture.h"
#include "scene/scene.h"

// What a user can choose of a view, field by field. Options, help, shots, metadata, results and the checks of
// `validate` are all made from this one table: a field that is added here is in each of them.

namespace airlight::scene {

enum class FieldKind {
  number,     ///< double
  vector,     ///< glm::dvec3
  direction,  ///< glm::dvec3 of any length but 0; only its direction is kept
  angles,     ///< azimuth and elevation of a direction [degrees]: glm::dvec2
  cone,    ///< inner and outer half-angle of a spot, 0 ≤ inner ≤ outer, outer > 0 [degrees]: glm::dvec2
  colour,  ///< RGB, none negative, within single precision: glm::dvec3; one number stands for all three
  word,    ///< one of the field's words, or any where it lists none: std::string
  file,    ///< a light texture, written as the name of its file
  size,    ///< width and height, both at least 1: glm::ivec2
};

using FieldValue = std::variant<double, glm::dvec2, glm::dvec3, std::string, glm::ivec2,
                                std::shared_ptr<const LightTexture>>;

/// What is wrong with a value; whoever took it from the user says where.
struct FieldProblem {
  std::string problem, remedy;
};

/// What a number, or each part of three, can be.
struct FieldRange {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool is_open = false;    ///< the bounds themselves cannot be
  std::string_view why{};  ///< remedy where a colour is above
};

/// What a field is, whatever it is a field of.
struct FieldInfo {
  std::string_view group;  ///< table of a shot; empty where it stands outside of any
  std::string_view name;   ///< the option, without dashes
  FieldKind kind;
  std::string_view placeholder;  ///< stands for a value in the help
  std::string_view label;        ///< goes before a value in reports and panels
  std::string_view meaning;
  std::string_view unit{};
  std::string_view note{};   ///< to whom gives it as an option
  std::string_view usual{};  ///< what it is where it is not given
  FieldRange range{};
  std::span<const std::string_view> words{};
  std::string_view own_key{};  ///< its key, where that does not follow from its name
  bool is_single = false;      ///< of a number: it is kept in single precision

  /// Its key in a shot and in the results: the name without the group, '_' for '-'; "name", where it names
  /// one of the group.
  std::string key() const;
  /// Its meaning with unit, words, note and default.
  std::string help() const;
  /// What is wrong with the value, whatever it is set in. The value is of this field's kind.
  std::optional<FieldProblem> problem(const FieldValue& value) const;
};

/// A field of a Camera, Light, Medium, Surroundings, View or Scene.
template <typename Thing>
struct Field : FieldInfo {
  void (*write)(Thing&, const FieldValue&);
  /// What is there, whether or not it can be.
  std::optional<FieldValue> (*read)(const Thing&);
  /// Why a thing as this one has no such field; nullptr for a field that each has.
  std::optional<FieldProblem> (*lack)(const Thing&) = nullptr;

  /// Leaves the thing as it is where something is wrong.
  [[nodiscard]] std::optional<FieldProblem> set(Thing& thing, const FieldValue& value) const {
    if (auto wrong = problem(value)) return wrong;
    if (auto wrong = lack ? lack(thing) : std::nullopt) return wrong;
    write(thing, value);
    return std::nullopt;
  }
  /// None where the thing has none, as an isotropic medium has no g.
  std::optional<FieldValue> get(const Thing& thing) const {
    return lack && lack(thing) ? std::nullopt : read(thing);
  }
};

/// The fields of a kind of thing; one that others depend on stands before them.
template <typename Thing>
std::span<const Field<Thing>> fields();
template <>
std::span<const Field<Camera>> fields();
template <>
std::span<const Field<Light>> fields();
template <>
std::span<const Field<Medium>> fields();
template <>
std::span<const Field<Surroundings>> fields();
template <>
std::span<const Field<Scene>> fields();
template <>
std::span<const Field<View>> fields();

/// The field of that name, which is there.
template <typename Thing>
const Field<Thing>& field(std::string_view name) {
  std::size_t i = 0;
  while (fields<Thing>()[i].name != name) ++i;
  return fields<Thing>()[i];
}

/// Calls `visit(field, value)` for each field of which the thing has a value.
template <typename Thing, typename Visit>
void for_each_value(const Thing& thing, const Visit& visit) {
  for (const Field<Thing>& field : fields<Thing>())
    if (const auto value = field.get(thing)) visit(field, *value);
}

/// The same for a view, but its lights: its camera, its medium, its surroundings and what is its own.
/// @param visit (part, field, value); the part is "camera", "medium", or empty for the others
template <typename Visit>
void for_each_value_of_view(const View& view, const Visit& visit) {
  const auto visit_part = [&](std::string_view part, const auto& thing) {
    for_each_value(thing,
                   [&](const FieldInfo& field, const FieldValue& value) { visit(part, field, value); });
  };
  visit_part("camera", view.camera);
  visit_part("medium", view.medium);
  visit_part("", view.surroundings);
  visit_part("", view);
}

/// What chooses one of the things that a scene brings, by name or by number from 0.
const FieldInfo& camera_choice();
const FieldInfo& light_choice();

/// Where the sun stands by its angles: another way to write the field "sun".
const FieldInfo& sun_angles();

/// The direction of unit length, world axes.
/// @param angles azimuth from +Z towards +X, elevation above the horizon [degrees]
glm::dvec3 direction_of_angles(glm::dvec2 angles);

/// All of the above, in the order of the help.
std::span<const FieldInfo* const> every_field();

/// The one of that name; nullptr for none.
const FieldInfo* find_field(std::string_view name);

/// Reads the file of a light texture. The reader of images is no part of this folder: callers hand it in.
using LightTextureReader = std::function<LightTexture(const std::filesystem::path&)>;

/// What a text means as a value of the field; whether it can be is for `problem` to say.
/// @throws Error (usage) naming `where`, the option; what the reader throws
FieldValue value_of_text(const FieldInfo& field, const std::string& where, std::string_view text,
                         const LightTextureReader& read_light_texture);

/// The shortest text that reads back the same.
std::string text_of(const FieldValue& value);

}  // namespace airlight::scene
