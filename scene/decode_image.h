#pragma once

#include <span>

#include "scene/scene.h"

namespace airlight::scene {

/// Neither side of a texture can be longer: what every OpenGL 4.5 driver has room for [texels].
inline constexpr int k_largest_texture = 16384;

/// Decodes a PNG or JPEG file as sRGB with alpha, whatever it says itself of its colours: glTF has them
/// ignored. (Deviation: libpng converts a PNG that names another gamma.)
/// @throws std::runtime_error with what is wrong with it
TextureImage decode_image(std::span<const unsigned char> file);

}  // namespace airlight::scene
