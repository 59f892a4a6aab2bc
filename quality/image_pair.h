#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "quality/image_io.h"
#include "quality/metrics.h"

/// Metrics of anyone's images, whoever rendered them.
namespace airlight::quality {

/// An image that was read, and where from: for errors.
struct ImageFile {
  std::filesystem::path file;
  Image image;
};

/// @throws scene::Error as read_exr
ImageFile read_image(const std::filesystem::path& file);

/// The RGB of a layer: of the channels LAYER.R, LAYER.G, LAYER.B, without a layer R, G, B; or of LAYER.Y, in
/// grey.
/// @throws scene::Error (bad_file) where the image has no such channels, naming those that it has
std::vector<glm::vec3> layer_of(const ImageFile& image, const std::string& layer);

/// How far an image is from another one. What is relative to a reference that is black everywhere is NaN.
struct PairError {
  AirlightError all;
  std::optional<SameSurfaceError> same_surface;  ///< where both images have distance.Y
  double flip;                                   ///< the mean of HDR-ꟻLIP
};

/// @param layer as of layer_of
/// @throws scene::Error (bad_file) where sizes differ or a value is NaN or infinite
PairError pair_error(const ImageFile& image, const ImageFile& reference, const std::string& layer);

/// As lines of text.
std::string pair_error_text(const PairError& error);

/// The same, with the names of results.json.
std::string pair_error_json(const PairError& error);

/// Each channel that both images have, of the first less that of the second.
/// @throws scene::Error (bad_file) where sizes differ, or they have no channel in common
Image difference(const ImageFile& image, const ImageFile& reference);

/// A part of an image [pixels].
struct Crop {
  glm::ivec2 from, size;
};
/// @throws scene::Error (usage) where not all of it lies in the image
Image cropped(const ImageFile& image, const Crop& crop);

/// Size, metadata, and of each channel the least, mean and greatest of its finite values, and how many are
/// none.
std::string image_info(const ImageFile& image);

}  // namespace airlight::quality
