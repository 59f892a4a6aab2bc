#pragma once

#include <map>
#include <string>
#include <string_view>

#include "scene/error.h"
#include "scene/view_fields.h"

namespace airlight::scene {

/// The values that a command line or a shot gives to fields, and how each speaks of its fields.
class Choices {
 public:
  virtual ~Choices() = default;

  /// @throws `error` for a value that can never be
  void add(const FieldInfo& field, FieldValue value);

  /// nullptr for none
  const FieldValue* get(const FieldInfo& field) const;

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

/// Makes the scene's first camera, its first light, its medium and its own fields those chosen. Afterwards it
/// has a camera; a light, where it brings one or one was given.
/// @throws the choices' error where they contradict one another or the scene
void choose_all(const Choices& choices, Scene& scene);

}  // namespace airlight::scene
