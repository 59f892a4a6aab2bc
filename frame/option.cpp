#include "frame/option.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::frame {
namespace {

using scene::Error;
using scene::ExitCode;

std::string rule_of(const Counts& counts) {
  std::string rule =
      counts.multiple_of == 1 ? "a whole number" : fmt::format("a multiple of {}", counts.multiple_of);
  rule += counts.most == Counts{}.most ? fmt::format(", at least {}", counts.least)
                                       : fmt::format(" between {} and {}", counts.least, counts.most);
  if (!counts.automatic.empty()) rule += fmt::format(", or auto: {}", counts.automatic);
  return rule;
}

std::string names_of(const Words& words) {
  std::string names;
  for (const Word& word : words) names += fmt::format("{}{}", names.empty() ? "" : ", ", word.word);
  return names;
}

}  // namespace

std::string text_of(const OptionValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

std::string values_text(const Option& option) {
  if (const Words* words = std::get_if<Words>(&option.values)) return names_of(*words);
  return rule_of(std::get<Counts>(option.values));
}

std::string help_text(const Option& option, const void* defaults) {
  const std::string usual = text_of(option.get(defaults));
  const Words* words = std::get_if<Words>(&option.values);
  if (!words) return fmt::format("{}: {} (default: {})", option.text.meaning, values_text(option), usual);
  std::string list;
  for (const Word& word : *words) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", word.word);
    const std::string remark =
        fmt::format("{}{}{}", word.word == usual ? "default" : "",
                    word.word == usual && !word.meaning.empty() ? ": " : "", word.meaning);
    if (!remark.empty()) list += fmt::format(" ({})", remark);
  }
  return fmt::format("{}: {}", option.text.meaning, list);
}

std::size_t parse_word(const std::string& where, std::string_view value, const Words& words) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const Word& word) { return word.word == value; });
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  throw Error(ExitCode::usage, where, fmt::format("'{}' is unknown", value), "use " + names_of(words));
}

int parse_count(const std::string& where, std::string_view value, const Counts& counts) {
  if (value == "auto" && !counts.automatic.empty()) return 0;
  int count = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), count);
  if (error != std::errc() || end != value.data() + value.size() || !counts.allow(count))
    throw Error(ExitCode::usage, where, fmt::format("'{}' is not {}", value, rule_of(counts)));
  return count;
}

}  // namespace airlight::frame
