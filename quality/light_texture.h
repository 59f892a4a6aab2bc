#pragma once

#include <filesystem>

#include "scene/light_texture.h"

namespace airlight::quality {

/// Reads the channels R, G and B of an OpenEXR file as what a light radiates by direction.
/// @throws scene::Error (bad_file) where the file cannot be read, lacks a channel, or holds a value that is
/// negative or not finite
scene::LightTexture read_light_texture(const std::filesystem::path& file);

}  // namespace airlight::quality
