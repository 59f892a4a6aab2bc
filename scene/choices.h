#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/error.h"
#include "scene/view_fields.h"

namespace airlight::scene {

/// The values that a command line or a shot gives to fields, of one light's or of all that is no light's, and
/// how each speaks of its fields.
class Choices {
 public:
  virtual ~Choices() = default;

  /// @throws `error` for a value that can never be
  void add(const FieldInfo& field, FieldValue value);

  /// nullptr for none
  const FieldValue* get(const FieldInfo& field) const;

  bool is_empty() const { return values_.empty(); }

  /// The field as its user writes it.
  virtual std::string spell(const FieldInfo& field) const = 0;

  /// An error at the place where the user wrote it.
  virtual Error error(const FieldInfo& field, const std::string& problem,
                      const std::string& remedy = {}) const = 0;

 private:
  std::map<std::string_view, FieldValue> values_;
};

/// Sets the thing's fields to what was chosen.
template <typename Thing>
void choose(const Choices& choices, Thing& thing) {
  for (const Field<Thing>& field : fields<Thing>()) {
    const FieldValue* value = choices.get(field);
    if (const auto wrong = value ? field.set(thing, *value) : std::nullopt)
      throw choices.error(field, wrong->problem, wrong->remedy);
  }
}

/// Of things that have these names, the place of the one that is called so or, if none is, has that number; a
/// number is written as `list_of_names` lists it.
std::optional<std::size_t> find_named(std::span<const std::string> names, const std::string& text);

/// "'a' (0), 'b' (1)"
std::string list_of_names(std::span<const std::string> names);

/// Whether it is a field of a light, or chooses one.
bool is_of_light(const FieldInfo& field);

/// Whether it says which light is meant: one of the scene's, or a new one by where it stands.
bool names_light(const FieldInfo& field);

/// Makes the scene's first camera, its lights, its medium, its surroundings and its own fields those chosen.
/// Afterwards it has a camera; its lights are those chosen or, where none is, those that were on; each that
/// it has, on or off, has a name of its own.
/// @param choices of all that is no light's
/// @param lights the choices of each light. Where there is one alone that does not say which light it means,
/// it means the scene's only one
/// @throws the choices' error where they contradict one another or the scene
void choose_all(const Choices& choices, std::span<const std::unique_ptr<const Choices>> lights, Scene& scene);

}  // namespace airlight::scene
