#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace airlight::scene {

// Strict readings of what a user typed: the whole text is one decimal number, finite and inside the type's
// range. Each throws Error (usage) that names `where`, the option or key that the text belongs to.

/// @returns an integer of at least 1
int parse_count(const std::string& where, std::string_view text);

double parse_number(const std::string& where, std::string_view text);

/// Two numbers separated by a comma.
glm::dvec2 parse_pair(const std::string& where, std::string_view text);

/// Three numbers separated by commas.
glm::dvec3 parse_vector(const std::string& where, std::string_view text);

/// Three numbers separated by commas, or one that stands for all three.
glm::dvec3 parse_colour(const std::string& where, std::string_view text);

/// WIDTHxHEIGHT, both whole.
glm::ivec2 parse_size(const std::string& where, std::string_view text);

/// The parts between separators; empty parts are kept.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace airlight::scene
