#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <png.h>
#include <glm/glm.hpp>

// After cstdio, which it takes for granted.
#include <jpeglib.h>

namespace airlight::tests {

/// A PNG file. @param format libpng's: of 4 bytes, as RGBA, unless said otherwise
template <typename Texel>
std::string png_file(glm::ivec2 size, const std::vector<Texel>& texels,
                     std::uint32_t format = PNG_FORMAT_RGBA) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(size.x);
  image.height = static_cast<png_uint_32>(size.y);
  image.format = format;
  png_alloc_size_t bytes = 0;
  if (!png_image_write_to_memory(&image, nullptr, &bytes, 0, texels.data(), 0, nullptr))
    throw std::runtime_error(image.message);
  std::string file(bytes, '\0');
  if (!png_image_write_to_memory(&image, file.data(), &bytes, 0, texels.data(), 0, nullptr))
    throw std::runtime_error(image.message);
  file.resize(bytes);
  return file;
}

/// A JPEG file of best quality.
inline std::string jpeg_file(glm::ivec2 size, const std::vector<glm::u8vec3>& texels) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  jpeg_mem_dest(&jpeg, &bytes, &count);
  jpeg.image_width = static_cast<JDIMENSION>(size.x);
  jpeg.image_height = static_cast<JDIMENSION>(size.y);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<glm::u8vec3> rows = texels;
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = &rows[static_cast<std::size_t>(jpeg.next_scanline) * static_cast<std::size_t>(size.x)].x;
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string file(reinterpret_cast<const char*>(bytes), count);
  std::free(bytes);
  jpeg_destroy_compress(&jpeg);
  return file;
}

/// Two rows of two texels: red and green over blue and a half-transparent grey.
inline const std::vector<glm::u8vec4> k_four_texels = {
    {255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {188, 188, 188, 128}};

}  // namespace airlight::tests
