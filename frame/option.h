#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace airlight::frame {

/// One option's value, as results show it.
using OptionValue = std::variant<int, std::string>;

std::string text_of(const OptionValue& value);

/// One of the words that an option takes.
struct Word {
  std::string_view word;
  std::string_view meaning = {};  ///< a few words
};
using Words = std::vector<Word>;

/// The whole numbers that an option takes.
struct Counts {
  int least = 1;
  int most = 1 << 30;
  int multiple_of = 1;
  std::string_view automatic = {};  ///< what `auto`, kept as 0, stands for; empty where there is no such word

  bool allow(int count) const { return count >= least && count <= most && count % multiple_of == 0; }
};

/// What there is to say of an option, wherever it is shown: in the help, in tables, in panels.
struct OptionText {
  std::string_view name;                     ///< as in METHOD:name=value
  std::string_view meaning;                  ///< one line, without the values and the default
  std::string_view quality;                  ///< what another value does to the image, …
  std::string_view cost;                     ///< … and to time and memory
  std::vector<std::string_view> sweep = {};  ///< values worth comparing
  bool is_common = false;  ///< also an option of the command, --name, for every method that has it
};

/// One option of a method, whose options are the fields of a struct. Made by `word_option`, `count_option`
/// and the like, which know the struct's type; here it is forgotten, so that all methods' options are alike.
struct Option {
  OptionText text;
  std::variant<Words, Counts> values;

  /// @param options the method's options struct
  /// @throws scene::Error (usage) naming `where` and the valid values
  std::function<void(void* options, const std::string& where, std::string_view value)> set;
  std::function<OptionValue(const void* options)> get;
};

/// What an option takes: its words, or the rule of its counts.
std::string values_text(const Option& option);

/// Meaning, values and default, as the help shows them. @param defaults the method's options struct
std::string help_text(const Option& option, const void* defaults);

/// @returns which of the words `value` is
/// @throws scene::Error (usage) naming `where` and the words
std::size_t parse_word(const std::string& where, std::string_view value, const Words& words);

/// @returns the count, 0 for `auto`
/// @throws scene::Error (usage) naming `where` and what is allowed
int parse_count(const std::string& where, std::string_view value, const Counts& counts);

/// An option that is one of several words, read and written as an enumeration whose values count from 0.
/// @param read  Enum(const Options&) @param write void(Options&, Enum)
template <class Options, class Enum>
Option word_option(OptionText text, Words words, std::function<Enum(const Options&)> read,
                   std::function<void(Options&, Enum)> write) {
  return {
      std::move(text), words,
      [words, write](void* options, const std::string& where, std::string_view value) {
        write(*static_cast<Options*>(options), static_cast<Enum>(parse_word(where, value, words)));
      },
      [words, read](const void* options) -> OptionValue {
        return std::string(words[static_cast<std::size_t>(read(*static_cast<const Options*>(options)))].word);
      }};
}

template <class Options, class Enum>
Option word_option(OptionText text, Words words, Enum Options::*field) {
  return word_option<Options, Enum>(
      std::move(text), std::move(words), [field](const Options& options) { return options.*field; },
      [field](Options& options, Enum value) { options.*field = value; });
}

/// An option that is a whole number.
template <class Options>
Option count_option(OptionText text, const Counts& counts, int Options::*field) {
  return {std::move(text), counts,
          [counts, field](void* options, const std::string& where, std::string_view value) {
            static_cast<Options*>(options)->*field = parse_count(where, value, counts);
          },
          [counts, field](const void* options) -> OptionValue {
            const int count = static_cast<const Options*>(options)->*field;
            return count == 0 && !counts.automatic.empty() ? OptionValue("auto") : OptionValue(count);
          }};
}

/// The options of a struct that is a field of another one's, as options of that one.
template <class Outer, class Inner>
std::vector<Option> options_of(Inner Outer::*field, std::vector<Option> options) {
  for (Option& option : options) {
    option.set = [set = option.set, field](void* outer, const std::string& where, std::string_view value) {
      set(&(static_cast<Outer*>(outer)->*field), where, value);
    };
    option.get = [get = option.get, field](const void* outer) {
      return get(&(static_cast<const Outer*>(outer)->*field));
    };
  }
  return options;
}

}  // namespace airlight::frame
