#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "scene/error.h"
#include "scene/scene.h"

/// What the importers share, and no one else needs.
namespace airlight::scene {

Scene import_gltf(const std::filesystem::path& file);
Scene import_obj(const std::filesystem::path& file);
Scene import_ply(const std::filesystem::path& file);

/// Ear clipping takes time quadratic and worse in the number of corners.
inline constexpr std::size_t k_most_corners = 1000;

/// Triangles as a file gives them, in double precision and not yet checked.
struct RawGeometry {
  std::vector<glm::dvec3> positions;  ///< world space [m]
  std::vector<glm::uvec3> triangles;  ///< indices into `positions`, in range
  std::vector<std::uint32_t> material_of_triangle;
  std::vector<Material> materials;
  std::function<std::string(std::size_t)> place_of_vertex;  ///< where in the file a position comes from
};

/// Brings what a file holds into the form that `Geometry` promises.
///
/// Drops triangles of zero area and counts them; warns when nothing is left.
/// @throws Error for a position that is not finite, and for an extent that overflows single precision.
Geometry clean(const std::filesystem::path& file, RawGeometry raw, ImportReport& report);

/// An albedo of three reflectances. @throws Error when one is outside [0, 1].
glm::vec3 albedo(const std::filesystem::path& file, const std::string& place, glm::dvec3 value);

/// All bytes of a regular file. @throws Error when it is missing, not a file, empty, or cannot be read.
std::string read_file(const std::filesystem::path& file);

/// Text of a file made fit for one line of a message: control characters replaced, and shortened.
std::string printable(std::string_view text);

/// The words of a line; `words` is reused from line to line.
void split(std::string_view line, std::vector<std::string_view>& words);

/// The number that a word is, where it is decimal and finite in double precision.
std::optional<double> finite_decimal(std::string_view word);

/// Warns of `what`, unless the count is zero.
void count_warning(ImportReport& report, std::size_t count, std::string_view what);

/// An error of this file, at a place in it.
Error file_error(const std::filesystem::path& file, const std::string& place, const std::string& problem,
                 const std::string& remedy = {});

}  // namespace airlight::scene
