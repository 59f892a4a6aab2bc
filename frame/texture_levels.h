#pragma once

#include "scene/scene.h"

namespace airlight::frame {

/// The next level of a texture: half its size, rounded down, at least 1. Each texel is the mean of what it
/// covers, of colours in linear light; where a side is odd, three texels have a part in it.
scene::TextureImage next_level(const scene::TextureImage& image);

}  // namespace airlight::frame
