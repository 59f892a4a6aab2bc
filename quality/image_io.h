#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::quality {

/// An image of named 32-bit float channels, row 0 at the top, with string metadata.
struct Image {
  glm::ivec2 size{0};
  std::map<std::string, std::vector<float>>
      channels;  ///< e.g. "R", "airlight.G", "distance.Y"; size.x·size.y values each
  std::map<std::string, std::string> metadata;
};

/// An image that lies elsewhere, as `Image`.
struct ImageView {
  struct Channel {
    const float* first;  ///< of size.x·size.y values
    std::size_t step;    ///< from a value to the next, in floats
  };
  glm::ivec2 size{0};
  std::map<std::string, Channel> channels;
  const std::map<std::string, std::string>& metadata;
};

/// Writes OpenEXR with 32-bit float channels, on all cores, by run-length compression: seven times as fast as
/// ZIP, whose files are half as large.
/// @throws scene::Error (bad_file) when the file cannot be written, or a value is NaN or infinite (which
/// names the channel and pixel).
void write_exr(const std::filesystem::path& file, const ImageView& image);
void write_exr(const std::filesystem::path& file, const Image& image);

/// Reads every channel of an OpenEXR file as float, and its string attributes.
/// @throws scene::Error (bad_file)
Image read_exr(const std::filesystem::path& file);

/// Writes an 8-bit sRGB preview of linear radiance: exposure, tone map (quality/tone_map.h), sRGB transfer.
/// @throws scene::Error (bad_file)
void write_png(const std::filesystem::path& file, std::span<const glm::vec3> radiance, glm::ivec2 size,
               float exposure, scene::ToneMap tone_map = scene::ToneMap::none);

}  // namespace airlight::quality
