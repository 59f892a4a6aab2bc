#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scene/import_internal.h"

// Reads PLY, in ASCII and in binary of either byte order. Assimp 5.2 crashes on binary files that are cut off
// and passes on indices of vertices that do not exist, so the format, which is small, is read here.
//
// Based on: Greg Turk, The PLY Polygon File Format, 1994.

namespace airlight::scene {
namespace {

enum class Format { ascii, little_endian, big_endian };

template <typename T>
double read_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

struct Type {
  std::string_view name, sized_name;
  std::size_t bytes;
  bool is_integer;
  double (*read)(const char* bytes);  ///< in the machine's byte order
};
constexpr std::array<Type, 8> k_types = {{{"char", "int8", 1, true, read_as<std::int8_t>},
                                          {"uchar", "uint8", 1, true, read_as<std::uint8_t>},
                                          {"short", "int16", 2, true, read_as<std::int16_t>},
                                          {"ushort", "uint16", 2, true, read_as<std::uint16_t>},
                                          {"int", "int32", 4, true, read_as<std::int32_t>},
                                          {"uint", "uint32", 4, true, read_as<std::uint32_t>},
                                          {"float", "float32", 4, false, read_as<float>},
                                          {"double", "float64", 8, false, read_as<double>}}};

struct Property {
  std::string name;
  const Type* type;
  const Type* count_type;  ///< of a list; else nullptr
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  bool has_texture = false;
};

/// What the file holds, from the front.
struct Source {
  const std::filesystem::path& file;
  std::string_view rest;
  std::size_t line_number = 0;

  /// Takes one line, ended by \n or \r\n.
  std::string_view line() {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view text = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++line_number;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }
  Error line_error(const std::string& problem, const std::string& remedy = {}) const {
    return file_error(file, fmt::format("line {}", line_number), problem, remedy);
  }
};

const Type* find_type(const Source& source, std::string_view name) {
  const auto found = std::find_if(k_types.begin(), k_types.end(),
                                  [&](const Type& t) { return t.name == name || t.sized_name == name; });
  if (found == k_types.end()) throw source.line_error(fmt::format("there is no type '{}'", printable(name)));
  return &*found;
}

Header read_header(Source& source) {
  if (source.line() != "ply")
    throw file_error(source.file, "", "this is no PLY file: it does not begin with 'ply'");
  Header header;
  bool has_format = false;
  std::vector<std::string_view> words;
  while (!source.rest.empty()) {
    const std::string_view line = source.line();
    split(line, words);
    if (words.empty() || words[0] == "obj_info") continue;
    if (words[0] == "comment") {
      header.has_texture |= words.size() > 1 && words[1] == "TextureFile";
    } else if (words[0] == "format" && words.size() == 3 && words[2] == "1.0") {
      if (words[1] == "binary_little_endian")
        header.format = Format::little_endian;
      else if (words[1] == "binary_big_endian")
        header.format = Format::big_endian;
      else if (words[1] != "ascii")
        throw source.line_error(fmt::format("there is no format '{}'", printable(words[1])));
      has_format = true;
    } else if (words[0] == "element" && words.size() == 3) {
      Element element{std::string(words[1]), 0, {}};
      const char* end = words[2].data() + words[2].size();
      const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
      if (error != std::errc() || stop != end)
        throw source.line_error(fmt::format("'{}' is not a number of elements", printable(words[2])));
      for (const Element& other : header.elements)
        if (other.name == element.name)
          throw source.line_error(fmt::format("the element '{}' is there twice", printable(element.name)));
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property" && !header.elements.empty() &&
               words.size() == (words.size() > 1 && words[1] == "list" ? 5u : 3u)) {
      Property property{std::string(words.back()), find_type(source, words[words.size() - 2]), nullptr};
      if (words.size() == 5) property.count_type = find_type(source, words[2]);
      if (property.count_type && !property.count_type->is_integer)
        throw source.line_error("the length of a list must be an integer");
      for (const Property& other : header.elements.back().properties)
        if (other.name == property.name)
          throw source.line_error(fmt::format("the property '{}' is there twice", printable(property.name)));
      header.elements.back().properties.push_back(std::move(property));
    } else if (words[0] == "end_header" && words.size() == 1) {
      if (!has_format) throw source.line_error("the header names no format");
      return header;
    } else {
      throw source.line_error(fmt::format("'{}' is not understood", printable(line)));
    }
  }
  throw file_error(source.file, "", "the file ends inside its header");
}

/// The values of the body, one after another in each format. Nothing is believed of a count that the bytes
/// which remain cannot hold.
class Body {
 public:
  Body(Source& source, Format format) : source_(source), format_(format) {}

  void begin_element(const Element& element) {
    element_ = &element;
    std::size_t least =
        0;  // bytes of one item; a word and a space each in ASCII, where the last space may be missing
    for (const Property& p : element.properties)
      least += format_ == Format::ascii ? 2 : p.count_type ? p.count_type->bytes : p.type->bytes;
    const std::size_t rest = source_.rest.size() + (format_ == Format::ascii ? 1 : 0);
    if (least > 0 && element.count > rest / least)
      throw file_error(
          source_.file, fmt::format("element '{}'", printable(element.name)),
          fmt::format("{} of them do not fit into the {} bytes that remain: the file is cut off, or its "
                      "header is wrong",
                      element.count, source_.rest.size()));
  }

  void begin_item(std::size_t item) {
    item_ = item;
    at_ = 0;
    if (format_ != Format::ascii) return;
    do {
      if (source_.rest.empty()) throw error("the file ends before it");
      split(source_.line(), words_);
    } while (words_.empty());
  }
  void end_item() const {
    if (format_ == Format::ascii && at_ < words_.size())
      throw error(fmt::format("it has {} values, {} are expected", words_.size(), at_));
  }

  double value(const Type& type) {
    require(1, type);
    if (format_ == Format::ascii) {
      const std::string_view word = words_[at_++];
      const auto number = finite_decimal(word);
      if (!number) throw error(fmt::format("'{}' is not a finite number", printable(word)));
      if (type.is_integer && *number != std::floor(*number))
        throw error(fmt::format("'{}' is not an integer", printable(word)));
      return *number;
    }
    std::array<char, 8> bytes{};
    std::copy_n(source_.rest.begin(), type.bytes, bytes.begin());
    source_.rest.remove_prefix(type.bytes);
    if ((format_ == Format::little_endian) != (std::endian::native == std::endian::little))
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    return type.read(bytes.data());
  }

  std::size_t list_size(const Property& list) {
    const double size = value(*list.count_type);
    if (size < 0.0) throw error(fmt::format("a list of {} values", size));
    require(size, *list.type);
    return static_cast<std::size_t>(size);
  }

  void skip(std::size_t count, const Type& type) {
    require(static_cast<double>(count), type);
    if (format_ == Format::ascii)
      at_ += count;
    else
      source_.rest.remove_prefix(count * type.bytes);
  }

  Error error(const std::string& problem, const std::string& remedy = {}) const {
    const std::string item = fmt::format("{} {}", printable(element_->name), item_);
    return format_ == Format::ascii ? source_.line_error(fmt::format("{}: {}", item, problem), remedy)
                                    : file_error(source_.file, item, problem, remedy);
  }

 private:
  /// That many values are still there. (A double holds every count that a list can have.)
  void require(double count, const Type& type) const {
    if (format_ == Format::ascii) {
      if (count > static_cast<double>(words_.size() - at_)) throw error("it has too few values");
    } else if (count * static_cast<double>(type.bytes) > static_cast<double>(source_.rest.size())) {
      throw error("the file ends inside it");
    }
  }

  Source& source_;
  Format format_;
  const Element* element_ = nullptr;
  std::size_t item_ = 0;
  std::vector<std::string_view> words_;  ///< of an ASCII item
  std::size_t at_ = 0;                   ///< the next one
};

/// Twice the signed area of a triangle.
double area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Cuts a polygon's ears off; a convex one becomes a fan around its first corner.
/// @returns the number of triangles that could not be cut out, because the polygon crosses itself
std::size_t cut_polygon(std::vector<std::uint32_t> corners, const std::vector<glm::dvec3>& positions,
                        std::vector<glm::uvec3>& triangles) {
  // Seen along the axis to which it is most nearly perpendicular, and counter-clockwise.
  glm::dvec3 normal(0.0);
  for (std::size_t i = 2; i < corners.size(); ++i)
    normal += glm::cross(positions[corners[i - 1]] - positions[corners[0]],
                         positions[corners[i]] - positions[corners[0]]);
  if (normal == glm::dvec3(0.0)) {  // all on one line, or a bow tie
    for (std::size_t i = 2; i < corners.size(); ++i)
      triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
    return 0;
  }
  const glm::dvec3 size = glm::abs(normal);
  const int w = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (w + (normal[w] < 0.0 ? 2 : 1)) % 3, v = 3 - u - w;
  const auto at = [&](std::uint32_t i) { return glm::dvec2(positions[i][u], positions[i][v]); };

  std::size_t middle = 1, failures = 0;
  while (corners.size() > 3 && failures < corners.size()) {
    const std::size_t n = corners.size();
    middle %= n;
    const std::uint32_t before = corners[(middle + n - 1) % n], tip = corners[middle],
                        after = corners[(middle + 1) % n];
    const glm::dvec2 a = at(before), b = at(tip), c = at(after);
    const bool is_ear =
        area(a, b, c) > 0.0 && std::none_of(corners.begin(), corners.end(), [&](std::uint32_t i) {
          const glm::dvec2 p = at(i);
          return p != a && p != b && p != c && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 &&
                 area(c, a, p) >= 0.0;
        });
    if (is_ear) {
      triangles.emplace_back(before, tip, after);
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(middle));
      failures = 0;
    } else {
      ++middle;
      ++failures;
    }
  }
  if (corners.size() == 3) triangles.emplace_back(corners[0], corners[1], corners[2]);
  return corners.size() - 3;
}

bool lists_corners(const Property& property) {
  return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool names_colour(const Property& property) {
  static const std::set<std::string_view> k_names = {"red",         "green",         "blue",
                                                     "diffuse_red", "diffuse_green", "diffuse_blue"};
  return k_names.contains(property.name);
}

}  // namespace

Scene import_ply(const std::filesystem::path& file, Looks) {
  const std::string bytes = read_file(file);
  Scene scene;
  ImportReport& report = scene.report;
  Source source{file, bytes};
  const Header header = read_header(source);

  // What the header promises.
  std::size_t vertices = 0;
  bool has_vertices = false;
  for (const Element& element : header.elements) {
    const auto has = [&](std::string_view name) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [&](const Property& p) { return p.name == name && !p.count_type; });
    };
    if (element.name == "vertex") {
      if (!has("x") || !has("y") || !has("z"))
        throw file_error(file, "element 'vertex'", "its properties must include the numbers x, y and z");
      vertices = element.count;
      has_vertices = true;
    } else if (element.name == "face") {
      if (std::none_of(element.properties.begin(), element.properties.end(), lists_corners))
        throw file_error(file, "element 'face'", "its properties must include the list vertex_indices");
    } else {
      count_warning(report, element.count,
                    fmt::format("elements '{}' ignored: only faces are rendered", printable(element.name)));
    }
    if ((element.name == "vertex" || element.name == "face") &&
        std::any_of(element.properties.begin(), element.properties.end(), names_colour))
      report.warnings.push_back(fmt::format("{} colours ignored: surfaces have one colour", element.name));
  }
  if (!has_vertices) throw file_error(file, "", "the file has no element 'vertex'");
  if (header.has_texture) report.warnings.push_back("texture ignored: surfaces have one colour");

  // The body. Faces may come before the vertices, so they are cut afterwards.
  RawGeometry raw;
  raw.materials.emplace_back();
  raw.place_of_vertex = [](std::size_t vertex) { return fmt::format("vertex {}", vertex); };
  std::vector<std::vector<std::uint32_t>> polygons;  // of more than three corners
  std::vector<std::uint32_t> corners;
  std::size_t incomplete = 0, crossing = 0;
  Body body(source, header.format);
  for (const Element& element : header.elements) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (element.properties.empty()) continue;
    body.begin_element(element);
    for (std::size_t item = 0; item < element.count; ++item) {
      body.begin_item(item);
      if (is_vertex) raw.positions.emplace_back(0.0);
      for (const Property& property : element.properties) {
        if (!property.count_type) {
          if (is_vertex && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
            raw.positions.back()[property.name[0] - 'x'] = body.value(*property.type);
          else
            body.skip(1, *property.type);
          continue;
        }
        const std::size_t size = body.list_size(property);
        if (!is_face || !lists_corners(property)) {
          body.skip(size, *property.type);
          continue;
        }
        if (size > k_most_corners)
          throw body.error(fmt::format("a polygon of {} corners, the limit is {}", size, k_most_corners),
                           "triangulate the model");
        corners.clear();
        for (std::size_t corner = 0; corner < size; ++corner) {
          const double index = body.value(*property.type);
          if (!(index >= 0.0 && index < static_cast<double>(vertices)) || index != std::floor(index))
            throw body.error(fmt::format("vertex {} is out of range: {} vertices, from 0", index, vertices));
          corners.push_back(static_cast<std::uint32_t>(index));
        }
        if (size == 3)
          raw.triangles.emplace_back(corners[0], corners[1], corners[2]);
        else if (size > 3)
          polygons.push_back(corners);
        else
          ++incomplete;
      }
      body.end_item();
    }
  }
  if (source.rest.find_first_not_of(" \t\r\n") != source.rest.npos)
    report.warnings.push_back("what follows the last element is ignored");
  for (std::vector<std::uint32_t>& polygon : polygons)
    crossing += cut_polygon(std::move(polygon), raw.positions, raw.triangles);
  count_warning(report, incomplete, "faces of fewer than three corners ignored");
  count_warning(report, crossing, "triangles of polygons that cross themselves could not be cut out");
  raw.material_of_triangle.assign(raw.triangles.size(), 0);
  scene.geometry = clean(file, std::move(raw), report);
  return scene;
}

}  // namespace airlight::scene
