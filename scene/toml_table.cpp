#include "scene/toml_table.h"

#include <cstdint>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "scene/import_internal.h"

namespace airlight::scene {
namespace {

std::string line_of(const toml::source_region& source) {
  return fmt::format("line {}", source.begin.line);
}

constexpr const char* k_wanted_number = "it must be a number";
constexpr const char* k_wanted_vector = "it must be three numbers, as in [0, 1, 0]";

}  // namespace

toml::table read_toml(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw file_error(file, line_of(error.source()), printable(error.description()));
  }
}

Error Table::error(std::string_view key, const std::string& problem, const std::string& remedy) const {
  const toml::node* node = table_.get(key);
  const std::string place = line_of(node ? node->source() : table_.source());
  return file_error(file_, fmt::format("{}, {}{}{}", place, name_, name_.empty() ? "" : ".", key), problem,
                    remedy);
}

std::optional<std::string> Table::text(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (!node->is_string()) throw error(key, "it must be a text in quotes");
  return node->value<std::string>();
}

std::optional<double> Table::number(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  return number_of(key, *node, k_wanted_number);
}

std::optional<std::size_t> Table::count(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
  if (!value || *value < 1) throw error(key, "it must be a whole number, at least 1");
  return static_cast<std::size_t>(*value);
}

std::optional<glm::dvec3> Table::three_numbers(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  return vector_of<glm::dvec3>(key, *node, k_wanted_vector);
}

std::optional<glm::dvec4> Table::four_numbers(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  return vector_of<glm::dvec4>(key, *node, "it must be four numbers, as in [0, 0, 0, 1]");
}

std::optional<FieldValue> Table::value(const FieldInfo& field, const LightTextureReader& read_light_texture) {
  const std::string key = field.key();
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  switch (field.kind) {
    case FieldKind::number:
      return number_of(key, *node, k_wanted_number);
    case FieldKind::vector:
    case FieldKind::direction:
      return vector_of<glm::dvec3>(key, *node, k_wanted_vector);
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

Table Table::table(std::string_view key) {
  static const toml::table k_empty;
  const toml::node* node = find(key);
  const std::string heading = fmt::format("[{}]", key);
  if (node && !node->is_table()) throw error(key, fmt::format("it must be a table, begun by {}", heading));
  return {file_, node ? *node->as_table() : k_empty, std::string(key), heading};
}

std::vector<Table> Table::tables(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return {};
  const std::string heading = fmt::format("[[{}]]", key);
  if (!node->is_array_of_tables())
    throw error(key, fmt::format("it must be tables, each begun by {}", heading));
  std::vector<Table> tables;
  for (const toml::node& element : *node->as_array())
    tables.push_back(Table(file_, *element.as_table(), std::string(key), heading));
  return tables;
}

void Table::refuse_others() const {
  for (const auto& [key, value] : table_) {
    if (known_.contains(key.str())) continue;
    std::string names;
    for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
    throw file_error(
        file_, line_of(key.source()),
        fmt::format("there is no key '{}'{}{}", printable(key.str()), name_.empty() ? "" : " in ", heading_),
        "use " + names);
  }
}

const toml::node* Table::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

double Table::number_of(std::string_view key, const toml::node& node, const char* wanted) const {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) throw error(key, wanted);
  return *value;
}

template <typename Vector>
Vector Table::vector_of(std::string_view key, const toml::node& node, const char* wanted) const {
  const toml::array* array = node.as_array();
  if (!array || array->size() != static_cast<std::size_t>(Vector::length())) throw error(key, wanted);
  Vector value;
  for (int i = 0; i < Vector::length(); ++i)
    value[i] = number_of(key, (*array)[static_cast<std::size_t>(i)], wanted);
  return value;
}

FieldValue Table::texture(std::string_view key, const std::string& name,
                          const LightTextureReader& read) const {
  if (!read) throw error(key, "there is nothing to read light textures with");
  if (name.find('\0') != name.npos) throw error(key, "it is no name of a file");
  try {
    return std::make_shared<const LightTexture>(read(file_.parent_path() / name));
  } catch (const Error& problem) {
    throw error(key, problem.what());
  }
}

}  // namespace airlight::scene
