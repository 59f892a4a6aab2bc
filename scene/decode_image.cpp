#include "scene/decode_image.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <png.h>

// After cstdio, which it takes for granted.
#include <jerror.h>
#include <jpeglib.h>

namespace airlight::scene {
namespace {

std::size_t texel_count(glm::ivec2 size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

void require_size(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0) throw std::runtime_error(fmt::format("its size is {}x{}", width, height));
  if (std::max<std::uint64_t>(width, height) > k_largest_texture)
    throw std::runtime_error(fmt::format("its {}x{} texels are more than the limit of {} a side", width,
                                         height, k_largest_texture));
}

// ---- PNG ----

TextureImage decode_png(std::span<const unsigned char> file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto fail = [&] {
    const std::string message = png.message;
    png_image_free(&png);
    throw std::runtime_error("it is a broken PNG: " + message);
  };
  if (!png_image_begin_read_from_memory(&png, file.data(), file.size())) fail();
  try {
    require_size(png.width, png.height);
  } catch (...) {
    png_image_free(&png);
    throw;
  }
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  png.format = PNG_FORMAT_RGBA;
  TextureImage image;
  image.size = {static_cast<int>(png.width), static_cast<int>(png.height)};
  image.texels.resize(texel_count(image.size));
  if (!png_image_finish_read(&png, nullptr, image.texels.data(), 0, nullptr)) fail();
  return image;
}

// ---- JPEG ----

/// What libjpeg calls back with errors. It is left by longjmp: no destructor may be due in between.
struct JpegErrors {
  jpeg_error_mgr manager;  ///< first: libjpeg hands back a pointer to it
  std::jmp_buf failed;
  std::array<char, JMSG_LENGTH_MAX> message;
};

JpegErrors& errors_of(j_common_ptr jpeg) {
  return *reinterpret_cast<JpegErrors*>(jpeg->err);
}

[[noreturn]] void on_error(j_common_ptr jpeg) {
  jpeg->err->format_message(jpeg, errors_of(jpeg).message.data());
  std::longjmp(errors_of(jpeg).failed, 1);
}

/// Of a file that is cut off libjpeg makes up the rest, with a warning. Others, as of bytes between segments,
/// leave the image whole.
void on_message(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE))
    on_error(jpeg);
}

/// A decoder, and its end. What longjmp may jump over is done between its functions.
struct JpegDecoder {
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};

  JpegDecoder() {
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = on_error;
    errors.manager.emit_message = on_message;
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg); }

  /// Reads what stands before the image. @returns whether it could
  bool begin(std::span<const unsigned char> file) {
    if (setjmp(errors.failed)) return false;
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, file.data(), file.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = JCS_EXT_RGBA;  // alpha 255
    return true;
  }

  /// @param texels room for all
  bool finish(glm::u8vec4* texels) {
    if (setjmp(errors.failed)) return false;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
      JSAMPROW row = reinterpret_cast<JSAMPROW>(texels + static_cast<std::size_t>(jpeg.output_scanline) *
                                                             jpeg.output_width);
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    return true;
  }
};

TextureImage decode_jpeg(std::span<const unsigned char> file) {
  JpegDecoder decoder;
  const auto fail = [&] {
    throw std::runtime_error(fmt::format("it is a broken JPEG: {}", decoder.errors.message.data()));
  };
  if (!decoder.begin(file)) fail();
  require_size(decoder.jpeg.image_width, decoder.jpeg.image_height);
  TextureImage image;
  image.size = {static_cast<int>(decoder.jpeg.image_width), static_cast<int>(decoder.jpeg.image_height)};
  image.texels.resize(texel_count(image.size));
  if (!decoder.finish(image.texels.data())) fail();
  return image;
}

bool begins_with(std::span<const unsigned char> file, std::span<const unsigned char> start) {
  return file.size() >= start.size() && std::equal(start.begin(), start.end(), file.begin());
}

}  // namespace

TextureImage decode_image(std::span<const unsigned char> file) {
  static constexpr std::array<unsigned char, 4> k_png = {0x89, 'P', 'N', 'G'};
  static constexpr std::array<unsigned char, 2> k_jpeg = {0xff, 0xd8};
  if (begins_with(file, k_png)) return decode_png(file);
  if (begins_with(file, k_jpeg)) return decode_jpeg(file);
  throw std::runtime_error(file.empty() ? "it is empty" : "it is neither PNG nor JPEG");
}

}  // namespace airlight::scene
