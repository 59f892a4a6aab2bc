#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "scene/error.h"
#include "scene/view_fields.h"

/// How shots and paths read TOML, and no one else needs.
namespace airlight::scene {

/// @throws Error (bad_file) with file and line
toml::table read_toml(const std::filesystem::path& file);

/// A table of the file. Each key that is asked for is known; `refuse_others` refuses what is left.
/// What is read throws Error (bad_file) with file, line and key where it is of another type.
class Table {
 public:
  /// The file's own. Both are kept by reference.
  Table(const std::filesystem::path& file, const toml::table& root) : Table(file, root, "", "") {}

  bool has(std::string_view key) const { return table_.contains(key); }

  Error error(std::string_view key, const std::string& problem, const std::string& remedy = {}) const;

  std::optional<std::string> text(std::string_view key);
  std::optional<double> number(std::string_view key);

  /// A whole number, at least 1.
  std::optional<std::size_t> count(std::string_view key);

  std::optional<glm::dvec3> three_numbers(std::string_view key);
  std::optional<glm::dvec4> four_numbers(std::string_view key);

  /// None of a field of a size.
  std::optional<FieldValue> value(const FieldInfo& field, const LightTextureReader& read_light_texture);

  /// The table [key], empty where there is none.
  Table table(std::string_view key);

  /// The tables [[key]], in their order.
  std::vector<Table> tables(std::string_view key);

  void refuse_others() const;

 private:
  /// @param name as it stands in the file; empty for the file's own, as is the heading that begins it
  Table(const std::filesystem::path& file, const toml::table& table, std::string name, std::string heading)
      : file_(file), table_(table), name_(std::move(name)), heading_(std::move(heading)) {}

  const toml::node* find(std::string_view key);
  double number_of(std::string_view key, const toml::node& node, const char* wanted) const;
  template <typename Vector>
  Vector vector_of(std::string_view key, const toml::node& node, const char* wanted) const;
  FieldValue texture(std::string_view key, const std::string& name, const LightTextureReader& read) const;

  const std::filesystem::path& file_;
  const toml::table& table_;
  std::string name_, heading_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace airlight::scene
