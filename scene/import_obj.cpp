#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <istream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "scene/import_internal.h"

// Reads Wavefront OBJ. tinyobjloader takes text that is no number for zero and skips faces whose vertices do
// not exist, all without a word, so the lines that matter are checked before it sees them.

namespace airlight::scene {
namespace {

/// What the check of the lines learns.
struct Survey {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::size_t triangles = 0;  ///< that the faces are cut into
  std::size_t lines_and_points = 0;
  std::size_t unknown_lines = 0;
  std::string first_unknown;  ///< its place and text
  bool colors = false;
};

std::string place_of_line(std::size_t line_number) {
  return fmt::format("line {}", line_number);
}

/// Checks one `f` line: whole numbers, not zero, of vertices that are there or (positive ones) may yet come.
/// @returns the largest index that it names.
std::size_t check_face(const std::filesystem::path& file, std::size_t line_number,
                       const std::vector<std::string_view>& words, std::size_t vertices) {
  if (words.size() - 1 > k_most_corners)
    throw file_error(
        file, place_of_line(line_number),
        fmt::format("a polygon of {} corners, the limit is {}", words.size() - 1, k_most_corners),
        "triangulate the model");
  std::size_t largest_index = 0;
  for (std::size_t corner = 1; corner < words.size(); ++corner) {
    const std::string_view word = words[corner];
    const std::string_view number = word.substr(0, word.find('/'));
    int index = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
    if (error != std::errc() || end != number.data() + number.size() || index == 0)
      throw file_error(file, place_of_line(line_number),
                       fmt::format("'{}' is not a vertex of a face", printable(word)));
    if (index < 0 && static_cast<std::size_t>(-static_cast<std::int64_t>(index)) > vertices)
      throw file_error(file, place_of_line(line_number),
                       fmt::format("vertex {} is out of range: {} vertices so far", index, vertices));
    largest_index = std::max(largest_index, static_cast<std::size_t>(std::max(index, 0)));
  }
  return largest_index;
}

Survey survey_lines(const std::filesystem::path& file, std::string_view text) {
  // What has no bearing on the picture, and what tinyobjloader reads itself.
  static const std::set<std::string_view> k_known = {
      "vt", "vn",  "vw",    "g",        "o",        "s",      "t",      "mtllib",     "usemtl",
      "mg", "lod", "bevel", "c_interp", "d_interp", "usemap", "maplib", "shadow_obj", "trace_obj"};
  Survey survey;
  std::size_t line_number = 0, largest_index = 0, line_of_largest = 0;
  std::vector<std::string_view> words;
  while (!text.empty()) {
    // As in tinyobjloader, a line ends with \n, \r\n or \r.
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    split(text.substr(0, end), words);
    text.remove_prefix(std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size()));
    ++line_number;
    if (words.empty() || words[0].starts_with('#')) continue;

    if (words[0] == "v") {
      if (words.size() < 4)
        throw file_error(file, place_of_line(line_number), "a vertex needs three coordinates");
      for (std::size_t axis = 1; axis < 4; ++axis)
        if (!finite_decimal(words[axis]))
          throw file_error(file, place_of_line(line_number),
                           fmt::format("vertex {}: '{}' is not a finite number", survey.vertices + 1,
                                       printable(words[axis])));
      survey.colors |= words.size() >= 7;
      ++survey.vertices;
    } else if (words[0] == "f") {
      const std::size_t index = check_face(file, line_number, words, survey.vertices);
      if (index > largest_index) {
        largest_index = index;
        line_of_largest = line_number;
      }
      ++survey.faces;
      survey.triangles += words.size() > 3 ? words.size() - 3 : 0;
    } else if (words[0] == "l" || words[0] == "p") {
      ++survey.lines_and_points;
    } else if (!k_known.contains(words[0])) {
      if (survey.unknown_lines++ == 0)
        survey.first_unknown = fmt::format("line {}: '{}'", line_number, printable(words[0]));
    }
  }
  if (largest_index > survey.vertices)
    throw file_error(file, place_of_line(line_of_largest),
                     fmt::format("vertex {} is out of range: {} vertices", largest_index, survey.vertices));
  if (survey.vertices + survey.faces == 0 && survey.unknown_lines > 0)
    throw file_error(file, survey.first_unknown, "this is no OBJ file: it has neither vertices nor faces");
  return survey;
}

/// Finds .mtl files beside the model. (tinyobjloader's own reader splits the folder's name at colons.)
class MtlReader : public tinyobj::MaterialReader {
 public:
  explicit MtlReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* index_of_name, std::string* warnings,
                  std::string* errors) override {
    std::ifstream stream(folder_ / name);
    if (!stream) {
      *warnings += fmt::format("material file '{}' not found: its surfaces have the default colour\n", name);
      return false;
    }
    const std::size_t first = materials->size();
    tinyobj::LoadMtl(index_of_name, materials, &stream, warnings, errors);
    // Textures lie relative to the file that names them. Models of other systems have their separators.
    for (std::size_t i = first; i < materials->size(); ++i) {
      for (std::string* texture : {&(*materials)[i].diffuse_texname, &(*materials)[i].alpha_texname}) {
        std::replace(texture->begin(), texture->end(), '\\', '/');
        if (!texture->empty()) *texture = (folder_ / name).parent_path() / *texture;
      }
    }
    return true;
  }

 private:
  std::filesystem::path folder_;
};

/// One warning for each different line, with the number of times that it came.
void forward_warnings(const std::string& text, ImportReport& report) {
  std::map<std::string, std::size_t> count_of_line;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = printable(line.substr(std::min(line.find_first_not_of(". "), line.size())));
    if (!line.empty()) ++count_of_line[line];
  }
  for (const auto& [line, count] : count_of_line)
    report.warnings.push_back(count == 1 ? line : fmt::format("{} ({} times)", line, count));
}

TextureImage read_texture(const std::filesystem::path& model, const std::string& material,
                          const std::string& texture) {
  std::string bytes;
  try {
    bytes = read_file(texture);
  } catch (const Error& error) {
    throw texture_error(model, material, "", error.what());
  }
  return texture_image(model, material, fmt::format("'{}'", printable(texture)),
                       {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

Error range_error(const std::filesystem::path& file, const tinyobj::index_t& corner, std::string_view what,
                  int index, std::size_t count) {
  return file_error(file, fmt::format("a face at vertex {}", corner.vertex_index + 1),
                    fmt::format("{} {} is out of range: {}", what, index + 1, count));
}

/// 0 of a corner without one.
glm::vec3 normal(const std::filesystem::path& file, const tinyobj::attrib_t& attributes,
                 const tinyobj::index_t& corner) {
  if (corner.normal_index < 0) return glm::vec3(0.0f);
  const auto first = 3 * static_cast<std::size_t>(corner.normal_index);
  if (first + 2 >= attributes.normals.size())
    throw range_error(file, corner, "normal", corner.normal_index, attributes.normals.size() / 3);
  const double* n = &attributes.normals[first];
  return glm::vec3(n[0], n[1], n[2]);
}

/// Of a map_d: the format names none.
constexpr float k_least_alpha = 0.5f;

/// How a material's textures lie: those of map_Kd and map_d are at the same places.
/// @throws Error where they are not
const tinyobj::texture_option_t& texture_options(const std::filesystem::path& file,
                                                 const tinyobj::material_t& material) {
  const tinyobj::texture_option_t &colours = material.diffuse_texopt, &mask = material.alpha_texopt;
  if (material.alpha_texname.empty()) return colours;
  if (material.diffuse_texname.empty()) return mask;
  if (!std::ranges::equal(colours.origin_offset, mask.origin_offset) ||
      !std::ranges::equal(colours.scale, mask.scale) || colours.clamp != mask.clamp)
    throw file_error(file, fmt::format("material '{}'", printable(material.name)),
                     "its map_Kd and its map_d lie differently", "give both the same -o, -s and -clamp");
  return colours;
}

/// What a map_d cuts out, as alpha: that of the image, or its red where it is opaque.
TextureImage mask_of(TextureImage image) {
  if (std::ranges::all_of(image.texels, [](const glm::u8vec4& texel) { return texel.a == 255; }))
    for (glm::u8vec4& texel : image.texels) texel.a = texel.r;
  return image;
}

/// Where a corner lies in its material's texture, by the options -o and -s of the map, of three numbers each.
/// Images of MTL begin at the bottom.
glm::vec2 texture_place(const std::filesystem::path& file, const tinyobj::attrib_t& attributes,
                        const tinyobj::index_t& corner, const tinyobj::texture_option_t& options) {
  const auto first = 2 * static_cast<std::size_t>(corner.texcoord_index);
  if (first + 1 >= attributes.texcoords.size())
    throw range_error(file, corner, "texture coordinate", corner.texcoord_index,
                      attributes.texcoords.size() / 2);
  const double u = options.origin_offset[0] + options.scale[0] * attributes.texcoords[first];
  const double v = options.origin_offset[1] + options.scale[1] * attributes.texcoords[first + 1];
  return {static_cast<float>(u), static_cast<float>(1.0 - v)};
}

}  // namespace

Scene import_obj(const std::filesystem::path& file, Looks looks) {
  const std::string text = read_file(file);
  Scene scene;
  ImportReport& report = scene.report;

  // Check the lines, then let tinyobjloader cut polygons and read materials.
  const Survey survey = survey_lines(file, text);
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  std::istringstream stream(text);
  MtlReader mtl_reader(file.parent_path());
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &stream, &mtl_reader, true,
                        false) ||
      !errors.empty())
    throw file_error(file, "", printable(errors));
  forward_warnings(warnings, report);

  // Materials; the last one is for faces without any.
  RawGeometry raw;
  std::size_t textured = 0, masked = 0, emissive = 0, transparent = 0;
  std::map<std::pair<std::string, bool>, std::uint32_t> texture_of_file;  // and whether it is a mask
  const auto texture_of = [&](const std::string& where, const std::string& texture, bool is_mask) {
    const auto [known, is_new] =
        texture_of_file.try_emplace({texture, is_mask}, static_cast<std::uint32_t>(raw.textures.size()));
    if (is_new) {
      TextureImage image = read_texture(file, where, texture);
      raw.textures.push_back(is_mask ? mask_of(std::move(image)) : std::move(image));
    }
    return known->second;
  };
  for (const tinyobj::material_t& material : materials) {
    const glm::dvec3 diffuse(material.diffuse[0], material.diffuse[1], material.diffuse[2]);
    const std::string where = fmt::format("material '{}'", printable(material.name));
    raw.materials.push_back({albedo(file, where, diffuse)});
    const bool has_colours = !material.diffuse_texname.empty(), has_mask = !material.alpha_texname.empty();
    if (looks == Looks::textured) {
      Material& read = raw.materials.back();
      if (has_colours) read.texture = texture_of(where, material.diffuse_texname, false);
      if (has_mask) read.cut_out = {texture_of(where, material.alpha_texname, true), k_least_alpha};
      if (texture_options(file, material).clamp) read.wrap = {TextureWrap::clamp, TextureWrap::clamp};
    }
    textured += looks == Looks::flat && has_colours;
    masked += looks == Looks::flat && has_mask;
    emissive += material.emission[0] + material.emission[1] + material.emission[2] > 0.0;
    transparent += material.dissolve < 1.0;
  }
  raw.materials.emplace_back();
  count_warning(report, textured, "materials' textures ignored: surfaces have one colour");
  count_warning(report, masked, "materials' masks (map_d) ignored: surfaces are opaque");
  count_warning(report, emissive, "materials' emission ignored: only point lights and suns are rendered");
  count_warning(report, transparent, "transparent materials rendered opaque");

  // Positions and triangles.
  raw.place_of_vertex = [](std::size_t vertex) { return fmt::format("vertex {}", vertex + 1); };
  raw.positions.reserve(survey.vertices);
  for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3)
    raw.positions.emplace_back(attributes.vertices[i], attributes.vertices[i + 1],
                               attributes.vertices[i + 2]);
  std::map<std::uint32_t, std::uint32_t> plain;  // materials, by those that they are without a texture
  std::size_t untextured_triangles = 0;
  for (const tinyobj::shape_t& shape : shapes) {
    for (std::size_t face = 0; face < shape.mesh.material_ids.size(); ++face) {
      const tinyobj::index_t* corners = &shape.mesh.indices[3 * face];
      raw.triangles.emplace_back(corners[0].vertex_index, corners[1].vertex_index, corners[2].vertex_index);
      const int material = shape.mesh.material_ids[face];
      raw.material_of_triangle.push_back(material >= 0 ? static_cast<std::uint32_t>(material)
                                                       : static_cast<std::uint32_t>(materials.size()));
      if (looks == Looks::flat) continue;
      if (std::any_of(corners, corners + 3, [](const auto& corner) { return corner.normal_index >= 0; })) {
        raw.normals.resize(raw.triangles.size());
        for (std::size_t corner = 0; corner < 3; ++corner)
          raw.normals.back()[corner] = normal(file, attributes, corners[corner]);
      }
      std::uint32_t& of_triangle = raw.material_of_triangle.back();
      if (!is_textured(raw.materials[of_triangle])) continue;
      if (std::any_of(corners, corners + 3, [](const auto& corner) { return corner.texcoord_index < 0; })) {
        of_triangle = untextured(raw, of_triangle, plain);
        ++untextured_triangles;
        continue;
      }
      raw.texture_places.resize(raw.triangles.size());
      const tinyobj::texture_option_t& options =
          texture_options(file, materials[static_cast<std::size_t>(material)]);
      for (std::size_t corner = 0; corner < 3; ++corner)
        raw.texture_places.back()[corner] = texture_place(file, attributes, corners[corner], options);
    }
  }
  if (raw.triangles.size() < survey.triangles)
    count_warning(report, survey.triangles - raw.triangles.size(),
                  "triangles of polygons that cross themselves could not be cut out");

  // What the picture lacks.
  count_warning(report, untextured_triangles, k_untextured);
  count_warning(report, survey.lines_and_points, "lines and point sets ignored: only faces are rendered");
  if (survey.colors) report.warnings.push_back("vertex colours ignored: surfaces have one colour");
  if (survey.unknown_lines > 0)
    report.warnings.push_back(
        fmt::format("{} lines not understood, first {}", survey.unknown_lines, survey.first_unknown));
  scene.geometry = clean(file, std::move(raw), report);
  return scene;
}

}  // namespace airlight::scene
