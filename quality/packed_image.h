#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "quality/image_pair.h"

/// Images as text within a page. quality/page/images.js reads them.
namespace airlight::quality {

/// An image, row 0 at the top.
template <typename Pixel>
struct Pixels {
  glm::ivec2 size{0};
  std::vector<Pixel> values;  ///< size.x · size.y
};
using RgbPixels = Pixels<glm::vec3>;
using GreyPixels = Pixels<float>;

template <typename Pixel>
Pixels<Pixel> part_of(const Pixels<Pixel>& image, const Crop& part) {
  Pixels<Pixel> cut{part.size, {}};
  cut.values.reserve(static_cast<std::size_t>(part.size.x) * static_cast<std::size_t>(part.size.y));
  for (int y = 0; y < part.size.y; ++y) {
    const auto first = image.values.begin() + std::ptrdiff_t{part.from.y + y} * image.size.x + part.from.x;
    cut.values.insert(cut.values.end(), first, first + part.size.x);
  }
  return cut;
}

/// An image of 1/factor of the width and height, rounded up, of means over factor × factor pixels, or fewer
/// at the right and the bottom.
template <typename Pixel>
Pixels<Pixel> reduced(const Pixels<Pixel>& image, int factor) {
  Pixels<Pixel> small{(image.size + factor - 1) / factor, {}};
  for (int y = 0; y < small.size.y; ++y) {
    for (int x = 0; x < small.size.x; ++x) {
      const glm::ivec2 from = glm::ivec2(x, y) * factor, to = glm::min(from + factor, image.size);
      Pixel sum(0.0f);
      for (int v = from.y; v < to.y; ++v)
        for (int u = from.x; u < to.x; ++u)
          sum += image.values[static_cast<std::size_t>(v) * static_cast<std::size_t>(image.size.x) +
                              static_cast<std::size_t>(u)];
      small.values.push_back(sum / static_cast<float>((to.x - from.x) * (to.y - from.y)));
    }
  }
  return small;
}

/// 16 bits a channel: half floats of value / unit, cut at the largest, 65504. What is alike in neighbouring
/// pixels and channels is taken out, without loss, so that deflate finds little left: of each pixel's bits
/// G, R − G, B − G, modulo 65536; of each of these three planes, one after the other, the differences from
/// value to value; all low bytes, and then all high ones; zlib's deflate; base64.
std::string packed(const RgbPixels& image, float unit);

/// 8 bits a pixel: round(255 · value) of values within 0 and 1, the differences modulo 256, deflate, base64.
std::string packed(const GreyPixels& image);

std::string base64(std::string_view bytes);

}  // namespace airlight::quality
