#include "quality/packed_image.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include <zlib.h>
#include <glm/gtc/packing.hpp>

namespace airlight::quality {
namespace {

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed_bytes(size, '\0');
  [[maybe_unused]] const int status = compress2(reinterpret_cast<Bytef*>(packed_bytes.data()), &size,
                                                reinterpret_cast<const Bytef*>(bytes.data()),
                                                static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
  assert(status == Z_OK);  // there is room
  packed_bytes.resize(size);
  return packed_bytes;
}

char low_byte(unsigned value) {
  return static_cast<char>(static_cast<std::uint8_t>(value & 0xffu));
}

}  // namespace

std::string base64(std::string_view bytes) {
  static constexpr std::string_view k_digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? k_digits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string packed(const RgbPixels& image, float unit) {
  constexpr float k_largest = 65504.0f;
  const std::size_t pixels = image.values.size();
  std::vector<std::uint16_t> planes(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const glm::vec3 value = glm::clamp(image.values[i] / unit, -k_largest, k_largest);
    const unsigned r = glm::packHalf1x16(value.r), g = glm::packHalf1x16(value.g),
                   b = glm::packHalf1x16(value.b);
    planes[i] = static_cast<std::uint16_t>(g);
    planes[pixels + i] = static_cast<std::uint16_t>(r - g);
    planes[2 * pixels + i] = static_cast<std::uint16_t>(b - g);
  }
  std::string low, high;
  for (std::size_t plane = 0; plane < 3; ++plane) {
    unsigned before = 0;
    for (std::size_t i = plane * pixels; i < (plane + 1) * pixels; ++i) {
      const unsigned difference = planes[i] - before;
      before = planes[i];
      low += low_byte(difference);
      high += low_byte(difference >> 8);
    }
  }
  return base64(deflated(low + high));
}

std::string packed(const GreyPixels& image) {
  std::string bytes;
  unsigned before = 0;
  for (const float value : image.values) {
    const auto byte = static_cast<unsigned>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    bytes += low_byte(byte - before);
    before = byte;
  }
  return base64(deflated(bytes));
}

}  // namespace airlight::quality
