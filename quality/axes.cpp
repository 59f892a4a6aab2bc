#include "quality/axes.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/error.h"
#include "scene/numbers.h"
#include "scene/toml_table.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;

constexpr std::size_t k_most_words = 100000;

/// The entries of a list, by the commas outside of braces.
std::vector<std::string_view> split_outside_braces(const std::string& where, std::string_view list) {
  const auto bad = [&](const std::string& problem) {
    return Error(ExitCode::usage, where, fmt::format("'{}': {}", list, problem),
                 "write a list of values as {64,128,256}");
  };
  std::vector<std::string_view> entries;
  std::size_t begin = 0;
  bool is_inside = false;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i] == '{') {
      if (is_inside) throw bad("there are braces within braces");
      is_inside = true;
    } else if (list[i] == '}') {
      if (!is_inside) throw bad("a brace closes that none opens");
      is_inside = false;
    } else if (list[i] == ',' && !is_inside) {
      entries.push_back(list.substr(begin, i - begin));
      begin = i + 1;
    }
  }
  if (is_inside) throw bad("a brace opens that none closes");
  entries.push_back(list.substr(begin));
  return entries;
}

/// Of an entry whose braces match.
void expand_entry(const std::string& where, std::string_view entry, std::vector<std::string>& words) {
  const std::size_t opens = entry.find('{'), closes = entry.find('}');
  if (opens == std::string_view::npos) {
    if (words.size() == k_most_words)
      throw Error(ExitCode::usage, where, fmt::format("it has more than {} settings", k_most_words),
                  "give shorter lists");
    words.emplace_back(entry);
    return;
  }
  for (std::string_view value : scene::split(entry.substr(opens + 1, closes - opens - 1), ',')) {
    if (value.empty())
      throw Error(ExitCode::usage, where, fmt::format("'{}': a value in braces is empty", entry),
                  "write a list of values as {64,128,256}");
    expand_entry(where, fmt::format("{}{}{}", entry.substr(0, opens), value, entry.substr(closes + 1)),
                 words);
  }
}

/// Reads nodes of a file of axes.
class AxesFile {
 public:
  explicit AxesFile(const std::filesystem::path& file) : file_(file), root_(scene::read_toml(file)) {}

  Axes axes() const {
    Axes axes;
    for (const auto& [key, node] : root_) {
      const std::string name(key.str());
      if (name == "shadow-map")
        axes.shadow_maps = values(name, node);
      else if (name == "volume")
        axes.volumes = methods(name, node);
      else if (name == "surface")
        axes.surfaces = methods(name, node);
      else
        throw error(node, name, "there is no such axis", "use shadow-map, [[volume]] or [[surface]]");
    }
    return axes;
  }

 private:
  Error error(const toml::node& node, const std::string& name, const std::string& problem,
              const std::string& remedy = {}) const {
    return Error(ExitCode::bad_file, file_.string(),
                 fmt::format("line {}, {}: {}", node.source().begin.line, name, problem), remedy);
  }

  std::string value(const std::string& name, const toml::node& node) const {
    if (const auto count = node.value_exact<std::int64_t>()) return fmt::format("{}", *count);
    const auto word = node.value_exact<std::string>();
    if (!word) throw error(node, name, "it must be whole numbers or texts in quotes");
    if (word->empty() || word->find_first_of("{},:=") != std::string::npos)
      throw error(node, name, fmt::format("'{}' is no word", *word));
    return *word;
  }

  /// One, or a list in braces.
  std::string values(const std::string& name, const toml::node& node) const {
    const toml::array* array = node.as_array();
    if (!array) return value(name, node);
    if (array->empty()) throw error(node, name, "it has no values");
    std::string list;
    for (const toml::node& element : *array)
      list += fmt::format("{}{}", list.empty() ? "" : ",", value(name, element));
    return fmt::format("{{{}}}", list);
  }

  std::string methods(const std::string& name, const toml::node& node) const {
    const toml::array* array = node.as_array();
    if (!array || !array->is_array_of_tables())
      throw error(node, name, "it must be tables", fmt::format("write [[{}]]", name));
    std::string list;
    for (const toml::node& element : *array) {
      const toml::table& table = *element.as_table();
      const toml::node* method = table.get("method");
      if (!method) throw error(element, name, "its method is missing", "write method = \"NAME\"");
      std::string spec = value(name + ".method", *method);
      for (const auto& [key, option] : table) {
        if (key.str() == "method") continue;
        spec += fmt::format(":{}={}", key.str(), values(fmt::format("{}.{}", name, key.str()), option));
      }
      list += fmt::format("{}{}", list.empty() ? "" : ",", spec);
    }
    return list;
  }

  std::filesystem::path file_;
  toml::table root_;
};

}  // namespace

std::vector<std::string> expand_braces(const std::string& where, std::string_view list) {
  std::vector<std::string> words;
  for (std::string_view entry : split_outside_braces(where, list)) expand_entry(where, entry, words);
  return words;
}

Axes read_axes(const std::filesystem::path& file) {
  return AxesFile(file).axes();
}

std::vector<VolumeChoice> settings_worth_sweeping(const VolumeMethod& method,
                                                  std::span<const CommonOption> common, std::size_t most) {
  constexpr std::size_t k_usual = static_cast<std::size_t>(-1), k_draws_per_setting = 50;
  std::vector<const frame::Option*> options;
  double product = 1.0;
  for (const frame::Option& option : method.options) {
    if (option.text.sweep.empty()) continue;
    options.push_back(&option);
    product *= static_cast<double>(option.text.sweep.size());
  }

  // A setting says which of its values each option has.
  std::vector<VolumeChoice> settings;
  std::vector<std::map<std::string, frame::OptionValue>> seen;
  const VolumeChoice usual = parse_volumes(std::string(method.name), common)[0];
  const std::map<std::string, frame::OptionValue> usual_values = usual.values();
  const auto add = [&](const std::vector<std::size_t>& values) {
    if (settings.size() == most) return;
    std::string spec(method.name);
    for (std::size_t i = 0; i < options.size(); ++i) {
      if (values[i] == k_usual) continue;
      const std::string_view value = options[i]->text.sweep[values[i]], name = options[i]->text.name;
      if (frame::text_of(usual_values.at(std::string(name))) != value)
        spec += fmt::format(":{}={}", name, value);
    }
    try {
      VolumeChoice choice = parse_volumes(spec, common)[0];
      if (std::find(seen.begin(), seen.end(), choice.values()) != seen.end()) return;
      seen.push_back(choice.values());
      settings.push_back(std::move(choice));
    } catch (const Error&) {
      // Options that contradict each other make no setting.
    }
  };

  std::vector<std::size_t> values(options.size(), k_usual);
  if (product <= static_cast<double>(most)) {
    values.assign(options.size(), 0);
    for (auto left = static_cast<std::size_t>(product); left > 0; --left) {
      add(values);
      for (std::size_t i = options.size(); i-- > 0;) {
        if (++values[i] < options[i]->text.sweep.size()) break;
        values[i] = 0;
      }
    }
    return settings;
  }
  add(values);
  for (std::size_t i = 0; i < options.size(); ++i) {
    for (std::size_t value = 0; value < options[i]->text.sweep.size(); ++value) {
      values[i] = value;
      add(values);
    }
    values[i] = k_usual;
  }
  std::mt19937_64 random(1);
  for (std::size_t draw = 0; draw < k_draws_per_setting * most && settings.size() < most; ++draw) {
    for (std::size_t i = 0; i < options.size(); ++i) values[i] = random() % options[i]->text.sweep.size();
    add(values);
  }
  return settings;
}

}  // namespace airlight::quality
