#include "quality/image_io.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <exception>
#include <system_error>
#include <thread>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>
#include <png.h>

#include "quality/tone_map.h"
#include "scene/error.h"
#include "scene/srgb.h"

namespace airlight::quality {

namespace {

/// No image decompresses to more than this many times its file: deflate's limit is 1032. What claims more is
/// damaged, and memory is not given to it. Small images are let through unasked.
constexpr std::uintmax_t k_largest_expansion = 2048;
constexpr std::uintmax_t k_small_image = 64 << 20;  ///< bytes

/// From here on a preview is compressed fast rather than well.
constexpr std::size_t k_large_preview = 1 << 20;  ///< pixels

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem,
                       const std::string& remedy = {}) {
  throw scene::Error(scene::ExitCode::bad_file, file.string(), problem, remedy);
}

void require_finite(const std::filesystem::path& file, const std::string& name,
                    const ImageView::Channel& channel, glm::ivec2 size) {
  const auto width = static_cast<std::size_t>(size.x);
  for (std::size_t y = 0; y < static_cast<std::size_t>(size.y); ++y) {
    const float* row = channel.first + y * width * channel.step;
    float sum = 0.0f;  // NaN where a value is infinite or NaN; a whole row is summed up at once
    for (std::size_t x = 0; x < width; ++x) sum += 0.0f * row[x * channel.step];
    if (sum == 0.0f) continue;
    std::size_t x = 0;
    while (std::isfinite(row[x * channel.step])) ++x;
    fail(file, fmt::format("channel {} is {} at pixel ({}, {})", name, row[x * channel.step], x, y));
  }
}

std::size_t pixel_count(glm::ivec2 size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// A slice whose memory begins at the first pixel of a data window. Writing takes the same one as reading,
/// and leaves the values alone.
Imf::Slice slice(const ImageView::Channel& channel, const Imath::Box2i& window) {
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  const std::size_t step = channel.step * sizeof(float);
  return Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(channel.first), window, step, width * step);
}

int thread_count() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
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
    frame.insert(channel.name(), slice({values.data(), 1}, window));
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

}  // namespace

void write_exr(const std::filesystem::path& file, const ImageView& image) {
  if (image.size.x < 1 || image.size.y < 1) fail(file, "the image has no pixels");
  for (const auto& [name, channel] : image.channels) require_finite(file, name, channel, image.size);
  try {
    Imf::Header header(image.size.x, image.size.y);
    header.compression() = Imf::RLE_COMPRESSION;
    Imf::FrameBuffer frame;
    for (const auto& [name, channel] : image.channels) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      frame.insert(name, slice(channel, header.dataWindow()));
    }
    for (const auto& [name, text] : image.metadata) header.insert(name, Imf::StringAttribute(text));
    if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(thread_count());
    Imf::OutputFile output(file.c_str(), header, thread_count());
    output.setFrameBuffer(frame);
    output.writePixels(image.size.y);
  } catch (const std::exception& error) {
    fail(file, fmt::format("cannot be written: {}", error.what()));
  }
}

void write_exr(const std::filesystem::path& file, const Image& image) {
  ImageView view{.size = image.size, .channels = {}, .metadata = image.metadata};
  for (const auto& [name, values] : image.channels) {
    assert(values.size() == pixel_count(image.size));
    view.channels[name] = {values.data(), 1};
  }
  write_exr(file, view);
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
  for (const auto& [name, values] : image.channels)
    require_finite(file, name, {values.data(), 1}, image.size);
  return image;
}

void write_png(const std::filesystem::path& file, std::span<const glm::vec3> radiance, glm::ivec2 size,
               float exposure, scene::ToneMap tone_map) {
  if (size.x < 1 || size.y < 1) fail(file, "the image has no pixels");
  assert(radiance.size() == pixel_count(size));
  static const scene::SrgbEncoder encode;
  std::vector<std::uint8_t> encoded(3 * radiance.size());
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const float value = radiance[i][channel];
      if (!std::isfinite(value)) {
        fail(file, fmt::format("channel {} is {} at pixel ({}, {})", "RGB"[channel], value,
                               i % static_cast<std::size_t>(size.x), i / static_cast<std::size_t>(size.x)));
      }
    }
    const glm::vec3 shown = tone_mapped(tone_map, exposure * radiance[i]);
    for (int channel = 0; channel < 3; ++channel)
      encoded[3 * i + static_cast<std::size_t>(channel)] = encode(shown[channel]);
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(size.x);
  image.height = static_cast<png_uint_32>(size.y);
  image.format = PNG_FORMAT_RGB;
  if (pixel_count(size) > k_large_preview) image.flags = PNG_IMAGE_FLAG_FAST;
  if (!png_image_write_to_file(&image, file.c_str(), 0, encoded.data(), 0, nullptr)) {
    fail(file, fmt::format("cannot be written: {}", image.message));
  }
}

}  // namespace airlight::quality
