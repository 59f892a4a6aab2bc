#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "quality/methods.h"

namespace airlight::quality {

/// A comma-separated list whose braces are written out: "vsv:alpha={64,128},none" is "vsv:alpha=64",
/// "vsv:alpha=128", "none". Several braces of an entry give their product, the last one changing fastest.
/// @param where the option, for errors
/// @throws scene::Error (usage) for braces that do not match, lie in one another or hold an empty word, and
/// for more than 100000 words in all
std::vector<std::string> expand_braces(const std::string& where, std::string_view list);

/// The lists that a sweep is the product of, as their options take them; none where the file has none.
struct Axes {
  std::optional<std::string> volumes, surfaces, shadow_maps;
};

/// Reads a TOML file of axes. A key of a method is one value or an array of them:
///
///     shadow-map = [512, 1024]
///     [[volume]]
///     method = "vsv"
///     alpha = [64, 128, 256]
///     integral = "table"
///     [[surface]]
///     method = "shadow-map"
///
/// @throws scene::Error (bad_file) with file and line
Axes read_axes(const std::filesystem::path& file);

/// Settings of a method made of the values that its description calls worth sweeping: all of their product
/// where that is at most `most`. Else the default, then each value by itself, one option after the other, and
/// then, until there are `most`, what is drawn from the product by a fixed seed. What contradicts itself, and
/// what is the same as another, is left out.
/// @param common as of parse_volumes
std::vector<VolumeChoice> settings_worth_sweeping(const VolumeMethod& method,
                                                  std::span<const CommonOption> common, std::size_t most);

}  // namespace airlight::quality
