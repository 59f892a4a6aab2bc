#include "scene/light_texture.h"

#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::scene {

namespace {

/// Times the largest intensity this leaves single precision room for what follows.
constexpr float k_brightest_texel = 1e6f;

}  // namespace

LightTexture::LightTexture(std::string name, glm::ivec2 size, std::vector<glm::vec3> texels)
    : name_(std::move(name)), size_(size), texels_(std::move(texels)) {
  if (size.x < 1 || size.y < 1) throw Error(ExitCode::bad_file, name_, "the light texture has no texels");
  const auto width = static_cast<std::size_t>(size.x);
  assert(texels_.size() == width * static_cast<std::size_t>(size.y));
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const float value = texels_[i][channel];
      if (value >= 0.0f && value <= k_brightest_texel) continue;
      throw Error(
          ExitCode::bad_file, name_,
          fmt::format("channel {} is {} at pixel ({}, {})", "RGB"[channel], value, i % width, i / width),
          fmt::format("a light radiates between 0 and {:g} times its intensity", k_brightest_texel));
    }
  }
}

}  // namespace airlight::scene
