#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "scene/error.h"
#include "scene/scene.h"

/// What the importers share, and no one else needs.
namespace airlight::scene {

Scene import_gltf(const std::filesystem::path& file, Looks looks);
Scene import_obj(const std::filesystem::path& file, Looks looks);
Scene import_ply(const std::filesystem::path& file, Looks looks);

/// Ear clipping takes time quadratic and worse in the number of corners.
inline constexpr std::size_t k_most_corners = 1000;

/// Triangles as a file gives them, in double precision and not yet checked.
struct RawGeometry {
  std::vector<glm::dvec3> positions;  ///< world space [m]
  std::vector<glm::uvec3> triangles;  ///< indices into `positions`, in range
  std::vector<std::uint32_t> material_of_triangle;
  std::vector<Material> materials;
  std::vector<TextureImage> textures;
  std::vector<std::array<glm::vec2, 3>> texture_places;  ///< as Geometry's; as many as triangles, or fewer
  /// As many as triangles, or fewer: of any length and on either side; 0 of corners that have none.
  std::vector<std::array<glm::vec3, 3>> normals;
  std::vector<std::uint32_t> node_of_triangle;              ///< as Geometry's: one a triangle, or none
  std::function<std::string(std::size_t)> place_of_vertex;  ///< where in the file a position comes from
};

/// The same material without its texture, for triangles that have no places in it: made where it is not
/// there.
/// @param known those made before, by their material
std::uint32_t untextured(RawGeometry& raw, std::uint32_t material,
                         std::map<std::uint32_t, std::uint32_t>& known);

/// What is said of those triangles, after their number.
inline constexpr std::string_view k_untextured =
    "triangles without texture coordinates shown without their material's textures";

/// Brings what a file holds into the form that `Geometry` promises.
///
/// Drops triangles of zero area and counts them; warns when nothing is left. Corners without a normal get
/// that of their triangle.
/// @throws Error for a position or a place in a texture that is not finite, and for one that overflows single
/// precision.
Geometry clean(const std::filesystem::path& file, RawGeometry raw, ImportReport& report);

/// An albedo of three reflectances. @throws Error when one is outside [0, 1].
glm::vec3 albedo(const std::filesystem::path& file, const std::string& place, glm::dvec3 value);

/// A texture of a material, decoded.
/// @param place names the material; @param image names the image, or is empty where the problem does
/// @throws Error naming them where it is no PNG or JPEG, broken or too large
TextureImage texture_image(const std::filesystem::path& file, const std::string& place,
                           const std::string& image, std::span<const unsigned char> bytes);

/// The error of a texture that cannot be shown.
Error texture_error(const std::filesystem::path& file, const std::string& place, const std::string& image,
                    const std::string& problem);

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
