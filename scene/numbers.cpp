#include "scene/numbers.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::scene {
namespace {

[[noreturn]] void refuse(const std::string& where, std::string_view text, const std::string& expected) {
  throw Error(ExitCode::usage, where, fmt::format("'{}' is not {}", text, expected));
}

/// @returns whether the whole text is one number that fits
template <typename T>
bool read(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

template <typename Vector>
bool read_each(const std::vector<std::string_view>& parts, Vector& value) {
  bool good = parts.size() == static_cast<std::size_t>(Vector::length());
  for (int i = 0; good && i < Vector::length(); ++i)
    good = read(parts[static_cast<std::size_t>(i)], value[i]) && std::isfinite(value[i]);
  return good;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

int parse_count(const std::string& where, std::string_view text) {
  int value = 0;
  if (!read(text, value) || value < 1) refuse(where, text, "a whole number from 1 to 2147483647");
  return value;
}

double parse_number(const std::string& where, std::string_view text) {
  double value = 0.0;
  if (!read(text, value) || !std::isfinite(value)) refuse(where, text, "a finite number");
  return value;
}

glm::dvec2 parse_pair(const std::string& where, std::string_view text) {
  glm::dvec2 value(0.0);
  if (!read_each(split(text, ','), value)) refuse(where, text, "two finite numbers a,b");
  return value;
}

glm::dvec3 parse_vector(const std::string& where, std::string_view text) {
  glm::dvec3 value(0.0);
  if (!read_each(split(text, ','), value)) refuse(where, text, "three finite numbers x,y,z");
  return value;
}

glm::dvec3 parse_colour(const std::string& where, std::string_view text) {
  glm::dvec3 value(0.0);
  std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() == 1) parts.assign(3, text);
  if (!read_each(parts, value)) refuse(where, text, "one finite number, or three r,g,b");
  return value;
}

glm::ivec2 parse_size(const std::string& where, std::string_view text) {
  const std::vector<std::string_view> parts = split(text, 'x');
  glm::ivec2 size(0);
  if (parts.size() != 2 || !read(parts[0], size.x) || !read(parts[1], size.y))
    refuse(where, text, "WIDTHxHEIGHT in pixels, as in 512x512");
  return size;
}

}  // namespace airlight::scene
