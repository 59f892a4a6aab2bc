#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace airlight::tests {

using Json = nlohmann::json;

inline bool has_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  throw std::runtime_error("the schema has an unknown type " + type);
}

/// Where a value breaks a JSON Schema (draft 07), one line each. Knows the words that the schema of
/// results.json uses; throws on one it does not know. Every property must be described.
/// @param whole the schema that definitions are looked up in; nullptr where it is `schema` itself
inline std::vector<std::string> schema_violations(const Json& value, const Json& schema,
                                                  const std::string& where = "",
                                                  const Json* whole = nullptr) {
  if (!whole) whole = &schema;
  std::vector<std::string> violations;
  const auto violated = [&](const std::string& what) { violations.push_back(where + ": " + what); };
  const auto add = [&](const std::vector<std::string>& more) {
    violations.insert(violations.end(), more.begin(), more.end());
  };

  for (const auto& [word, rule] : schema.items()) {
    if (word == "type") {
      const Json types = rule.is_array() ? rule : Json::array({rule});
      if (std::none_of(types.begin(), types.end(), [&](const Json& type) { return has_type(value, type); })) {
        violated(fmt::format("{} is not of type {}", value.dump(), rule.dump()));
      }
    } else if (word == "enum") {
      if (std::find(rule.begin(), rule.end(), value) == rule.end())
        violated(value.dump() + " is not one of " + rule.dump());
    } else if (word == "minimum") {
      if (value.is_number() && value < rule)
        violated(fmt::format("{} is less than {}", value.dump(), rule.dump()));
    } else if (word == "minItems") {
      if (value.is_array() && value.size() < rule) violated("too few items");
    } else if (word == "maxItems") {
      if (value.is_array() && value.size() > rule) violated("too many items");
    } else if (word == "items") {
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
        add(schema_violations(value[i], rule, fmt::format("{}/{}", where, i), whole));
      }
    } else if (word == "required") {
      for (const Json& name : rule) {
        if (value.is_object() && !value.contains(name.get<std::string>())) violated("lacks " + name.dump());
      }
    } else if (word == "properties") {
      for (const auto& [name, property] : rule.items()) {
        if (!property.contains("description")) violated("the schema does not say what " + name + " is");
        if (value.is_object() && value.contains(name)) {
          add(schema_violations(value[name], property, where + "/" + name, whole));
        }
      }
    } else if (word == "additionalProperties") {
      if (rule != false) throw std::runtime_error("only additionalProperties: false is known");
      for (const auto& [name, unused] : value.items()) {
        if (!schema.at("properties").contains(name)) violated("is not documented to have " + name);
      }
    } else if (word == "$ref") {
      const auto pointer = rule.get<std::string>().substr(1);  // after '#'
      add(schema_violations(value, whole->at(Json::json_pointer(pointer)), where, whole));
    } else if (word != "$schema" && word != "definitions" && word != "title" && word != "description") {
      throw std::runtime_error("the schema uses an unknown word " + word);
    }
  }
  return violations;
}

}  // namespace airlight::tests
