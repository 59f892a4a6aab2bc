#include "scene/import.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "scene/decode_image.h"
#include "scene/import_internal.h"

namespace airlight::scene {
namespace {

constexpr std::array<std::pair<std::string_view, Scene (*)(const std::filesystem::path&, Looks)>, 4>
    k_importers = {
        {{".gltf", import_gltf}, {".glb", import_gltf}, {".obj", import_obj}, {".ply", import_ply}}};

/// In single precision, as every method will see them: corners can coincide after rounding.
bool has_area_rounded(const RawGeometry& raw, glm::uvec3 triangle) {
  return has_area(glm::vec3(raw.positions[triangle.x]), glm::vec3(raw.positions[triangle.y]),
                  glm::vec3(raw.positions[triangle.z]));
}

/// Of unit length; 0 of what is no direction.
glm::vec3 unit_normal(glm::vec3 normal) {
  const glm::dvec3 n(normal);
  const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  if (!(largest > 0.0) || !std::isfinite(n.x + n.y + n.z)) return glm::vec3(0.0f);
  return glm::vec3(unit(n));
}

/// The normals of a triangle's corners, turned to the side of its own. Models are wound as they like: most of
/// the corners tell on which side theirs are.
std::array<glm::vec3, 3> turned_normals(const RawGeometry& raw, std::size_t triangle) {
  const glm::uvec3 t = raw.triangles[triangle];
  const glm::dvec3 a = raw.positions[t.x], b = raw.positions[t.y], c = raw.positions[t.z];
  const glm::vec3 own(unit(glm::cross(b - a, c - a)));
  std::array<glm::vec3, 3> normals{};
  float same_side = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    normals[i] = unit_normal(raw.normals[triangle][i]);
    same_side += glm::dot(normals[i], own);
  }
  for (glm::vec3& normal : normals) {
    if (normal == glm::vec3(0.0f))
      normal = own;
    else if (same_side < 0.0f)
      normal = -normal;
  }
  return normals;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::size_t k_longest = 200;
  std::string result(text.substr(0, k_longest));
  for (char& c : result)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  if (text.size() > k_longest) result += "...";
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

Error file_error(const std::filesystem::path& file, const std::string& place, const std::string& problem,
                 const std::string& remedy) {
  const std::string name = printable(file.string());
  return Error(ExitCode::bad_file, place.empty() ? name : name + ", " + place, problem, remedy);
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw file_error(file, "", "there is no such file");
  if (!std::filesystem::is_regular_file(status)) throw file_error(file, "", "it is not a file");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size == 0) throw file_error(file, "", "the file is empty");

  std::ifstream stream(file, std::ios::binary);
  std::string bytes(error ? 0 : size, '\0');
  if (error || !stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw file_error(file, "", "the file cannot be read");
  return bytes;
}

void split(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  constexpr std::string_view k_space = " \t";
  for (std::size_t at = line.find_first_not_of(k_space); at != line.npos;
       at = line.find_first_not_of(k_space, at)) {
    const std::size_t end = std::min(line.find_first_of(k_space, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
}

std::optional<double> finite_decimal(std::string_view word) {
  if (word.empty() || word.find_first_not_of("+-.0123456789eE") != word.npos) return std::nullopt;
  const std::string text(word);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return *end == '\0' && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void count_warning(ImportReport& report, std::size_t count, std::string_view what) {
  if (count > 0) report.warnings.push_back(fmt::format("{} {}", count, what));
}

glm::vec3 albedo(const std::filesystem::path& file, const std::string& place, glm::dvec3 value) {
  for (int channel = 0; channel < 3; ++channel)
    if (!(value[channel] >= 0.0 && value[channel] <= 1.0))
      throw file_error(file, place,
                       fmt::format("a base colour of {:g} is not between 0 and 1", value[channel]));
  return glm::vec3(value);
}

TextureImage texture_image(const std::filesystem::path& file, const std::string& place,
                           const std::string& image, std::span<const unsigned char> bytes) {
  try {
    return decode_image(bytes);
  } catch (const std::runtime_error& error) {
    throw texture_error(file, place, image, error.what());
  }
}

Error texture_error(const std::filesystem::path& file, const std::string& place, const std::string& image,
                    const std::string& problem) {
  return file_error(file, fmt::format("{}, texture{}{}", place, image.empty() ? "" : " ", image),
                    printable(problem), "repair it, or show the model by --looks flat");
}

std::uint32_t untextured(RawGeometry& raw, std::uint32_t material,
                         std::map<std::uint32_t, std::uint32_t>& known) {
  const auto [copy, is_new] = known.try_emplace(material, static_cast<std::uint32_t>(raw.materials.size()));
  if (is_new) {
    const glm::vec3 colour = raw.materials[material].albedo;
    raw.materials.push_back({colour});
  }
  return copy->second;
}

Geometry clean(const std::filesystem::path& file, RawGeometry raw, ImportReport& report) {
  // Every position is finite, and so are the squares of their distances.
  double reach = 0.0;
  for (std::size_t i = 0; i < raw.positions.size(); ++i) {
    const glm::dvec3 p = raw.positions[i];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      throw file_error(file, raw.place_of_vertex(i), "the position is not finite");
    reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  if (reach > k_largest_coordinate)
    throw file_error(
        file, "",
        fmt::format("the extent of the geometry overflows single precision: it reaches {:g} m from "
                    "the origin, the limit is {:g} m",
                    reach, k_largest_coordinate),
        "scale the model down");

  // And so is every place in a texture.
  for (std::size_t i = 0; i < raw.texture_places.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 2; ++axis)
        if (const float c = raw.texture_places[i][static_cast<std::size_t>(corner)][axis];
            !(std::abs(c) <= static_cast<float>(k_largest_coordinate)))
          throw file_error(file, raw.place_of_vertex(raw.triangles[i][corner]),
                           fmt::format("the texture coordinate {:g} is not finite, or overflows", c));
  if (!raw.texture_places.empty()) raw.texture_places.resize(raw.triangles.size());
  if (!raw.normals.empty()) raw.normals.resize(raw.triangles.size());

  // Triangles that have an area.
  Geometry geometry;
  geometry.triangles.reserve(raw.triangles.size());
  geometry.material_of_triangle.reserve(raw.triangles.size());
  geometry.texture_places.reserve(raw.texture_places.size());
  geometry.normals.reserve(raw.normals.size());
  geometry.node_of_triangle.reserve(raw.node_of_triangle.size());
  for (std::size_t i = 0; i < raw.triangles.size(); ++i) {
    assert(raw.material_of_triangle[i] < raw.materials.size());
    if (!has_area_rounded(raw, raw.triangles[i])) continue;
    geometry.triangles.push_back(raw.triangles[i]);
    geometry.material_of_triangle.push_back(raw.material_of_triangle[i]);
    if (!raw.texture_places.empty()) geometry.texture_places.push_back(raw.texture_places[i]);
    if (!raw.normals.empty()) geometry.normals.push_back(turned_normals(raw, i));
    if (!raw.node_of_triangle.empty()) geometry.node_of_triangle.push_back(raw.node_of_triangle[i]);
  }
  report.degenerate_triangles = raw.triangles.size() - geometry.triangles.size();
  if (geometry.triangles.empty()) report.warnings.push_back("the file has no triangles");

  geometry.positions.assign(raw.positions.begin(), raw.positions.end());
  geometry.materials = std::move(raw.materials);
  geometry.textures = std::move(raw.textures);
  return geometry;
}

Scene import_scene(const std::filesystem::path& file, Looks looks) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = std::find_if(k_importers.begin(), k_importers.end(),
                                  [&](const auto& importer) { return importer.first == extension; });
  if (found == k_importers.end())
    throw file_error(file, "",
                     extension.empty() ? "a file without an extension cannot be read"
                                       : fmt::format("{} files cannot be read", printable(extension)),
                     "give a .gltf, .glb, .obj or .ply file");

  try {
    Scene scene = found->second(file, looks);
    scene.name = file.stem().string();
    return scene;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    // The parsing libraries throw for some broken files; running out of memory is bad input, too.
    throw file_error(file, "", printable(error.what()));
  }
}

}  // namespace airlight::scene
