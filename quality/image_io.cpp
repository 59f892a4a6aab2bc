#include "quality/image_io.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <exception>
#include <system_error>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <png.h>

#include "scene/error.h"

namespace airlight::quality {

namespace {

/// No image decompresses to more than this many times its file: deflate's limit is 1032. What claims more is
/// damaged, and memory is not given to it. Small images are let through unasked.
constexpr std::uintmax_t k_largest_expansion = 2048;
constexpr std::uintmax_t k_small_image = 64 << 20;  ///< bytes

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem,
                       const std::string& remedy = {}) {
  throw scene::Error(scene::ExitCode::bad_file, file.string(), problem, remedy);
}

void require_finite(const std::filesystem::path& file, const std::string& channel,
                    std::span<const float> values, int width) {
  const auto culprit =
      std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
  if (culprit == values.end()) return;
  const auto pixel = culprit - values.begin();
  fail(file,
       fmt::format("channel {} is {} at pixel ({}, {})", channel, *culprit, pixel % width, pixel / width));
}

std::size_t pixel_count(glm::ivec2 size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// A slice whose memory begins at the first pixel of a data window.
Imf::Slice slice(float* values, const Imath::Box2i& window) {
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  return Imf::Slice::Make(Imf::FLOAT, values, window, sizeof(float), width * sizeof(float));
}

Image read_exr_unchecked(const std::filesystem::path& file) {
  Imf::InputFile input(file.c_str());
  const Imf::Header& header = input.header();
  const Imath::Box2i window = header.dataWindow();
  const auto width = static_cast<std::uintmax_t>(static_cast<std::int64_t>(window.max.x) - window.min.x + 1);
  const auto height = static_cast<std::uintmax_t>(static_cast<std::int64_t>(window.max.y) - window.min.y + 1);

  std::uintmax_t channel_count = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    ++channel_count;
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      fail(file, fmt::format("channel {} is subsampled", channel.name()), "write it at full resolution");
    }
  }
  const std::uintmax_t largest =
      std::max(k_small_image, k_largest_expansion * std::filesystem::file_size(file));
  if (width > largest || height > largest || channel_count * sizeof(float) * width > largest / height) {
    fail(file, fmt::format("too short for {}×{} pixels of {} channels", width, height, channel_count),
         "it is damaged or truncated; write it again");
  }

  Image image;
  image.size = glm::ivec2(static_cast<int>(width), static_cast<int>(height));
  Imf::FrameBuffer frame;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    std::vector<float>& values = image.channels[channel.name()];
    values.resize(pixel_count(image.size));
    frame.insert(channel.name(), slice(values.data(), window));
  }
  input.setFrameBuffer(frame);
  input.readPixels(window.min.y, window.max.y);

  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute())) {
      image.metadata[attribute.name()] = text->value();
    }
  }
  return image;
}

/// The sRGB transfer function, IEC 61966-2-1: linear [0, 1] to encoded [0, 1].
float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  if (image.size.x < 1 || image.size.y < 1) fail(file, "the image has no pixels");
  for (const auto& [name, values] : image.channels) {
    assert(values.size() == pixel_count(image.size));
    require_finite(file, name, values, image.size.x);
  }
  try {
    Imf::Header header(image.size.x, image.size.y);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    for (const auto& [name, values] : image.channels) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      // Writing takes the same slice as reading, and leaves the values alone.
      frame.insert(name, slice(const_cast<float*>(values.data()), header.dataWindow()));
    }
    for (const auto& [name, text] : image.metadata) header.insert(name, Imf::StringAttribute(text));
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame);
    output.writePixels(image.size.y);
  } catch (const std::exception& error) {
    fail(file, fmt::format("cannot be written: {}", error.what()));
  }
}

Image read_exr(const std::filesystem::path& file) {
  Image image;
  try {
    image = read_exr_unchecked(file);
  } catch (const scene::Error&) {
    throw;
  } catch (const std::exception& error) {
    fail(file, fmt::format("cannot be read as OpenEXR: {}", error.what()));
  }
  for (const auto& [name, values] : image.channels) require_finite(file, name, values, image.size.x);
  return image;
}

void write_png(const std::filesystem::path& file, std::span<const glm::vec3> radiance, glm::ivec2 size,
               float exposure) {
  if (size.x < 1 || size.y < 1) fail(file, "the image has no pixels");
  assert(radiance.size() == pixel_count(size));
  std::vector<std::uint8_t> encoded;
  encoded.reserve(3 * radiance.size());
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      if (!std::isfinite(radiance[i][channel])) {
        fail(file, fmt::format("channel {} is {} at pixel ({}, {})", "RGB"[channel], radiance[i][channel],
                               i % static_cast<std::size_t>(size.x), i / static_cast<std::size_t>(size.x)));
      }
      const float linear = std::clamp(exposure * radiance[i][channel], 0.0f, 1.0f);
      encoded.push_back(static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(linear))));
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(size.x);
  image.height = static_cast<png_uint_32>(size.y);
  image.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&image, file.c_str(), 0, encoded.data(), 0, nullptr)) {
    fail(file, fmt::format("cannot be written: {}", image.message));
  }
}

}  // namespace airlight::quality
