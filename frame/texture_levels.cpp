#include "frame/texture_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/srgb.h"

namespace airlight::frame {
namespace {

/// What a texel of the next level covers along one side.
struct Cover {
  std::size_t first;
  std::size_t count;
  std::array<float, 3> weights;  ///< their sum is 1
};

std::vector<Cover> covers(int size) {
  const int half = std::max(size / 2, 1);
  const double width = static_cast<double>(size) / half;
  std::vector<Cover> result;
  for (int i = 0; i < half; ++i) {
    const double begin = i * width, end = (i + 1) * width;
    const int first = static_cast<int>(begin), last = std::min(static_cast<int>(std::ceil(end)), size);
    Cover cover{static_cast<std::size_t>(first), static_cast<std::size_t>(std::min(last - first, 3)), {}};
    for (std::size_t k = 0; k < cover.count; ++k) {
      const double texel = first + static_cast<double>(k);
      cover.weights[k] = static_cast<float>((std::min(end, texel + 1.0) - std::max(begin, texel)) / width);
    }
    result.push_back(cover);
  }
  return result;
}

}  // namespace

scene::TextureImage next_level(const scene::TextureImage& image) {
  const std::array<double, 256>& linear = scene::linear_of_bytes();
  static const scene::SrgbEncoder encode;
  const std::vector<Cover> columns = covers(image.size.x), rows = covers(image.size.y);
  const auto width = static_cast<std::size_t>(image.size.x);
  scene::TextureImage level;
  level.size = {static_cast<int>(columns.size()), static_cast<int>(rows.size())};
  level.texels.reserve(columns.size() * rows.size());
  for (const Cover& row : rows) {
    for (const Cover& column : columns) {
      glm::vec4 sum(0.0f);
      for (std::size_t y = 0; y < row.count; ++y) {
        for (std::size_t x = 0; x < column.count; ++x) {
          const glm::u8vec4 texel = image.texels[(row.first + y) * width + column.first + x];
          sum += row.weights[y] * column.weights[x] *
                 glm::vec4(glm::vec3(linear[texel.r], linear[texel.g], linear[texel.b]), texel.a);
        }
      }
      level.texels.emplace_back(encode(sum.r), encode(sum.g), encode(sum.b),
                                static_cast<std::uint8_t>(std::min(sum.a + 0.5f, 255.0f)));
    }
  }
  return level;
}

}  // namespace airlight::frame
