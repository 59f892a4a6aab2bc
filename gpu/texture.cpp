#include "gpu/texture.h"

#include <algorithm>

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

struct FormatInfo {
  GLenum internal_format;
  GLenum channels, type;  ///< of texels that are written or read
  int transfer_bytes;     ///< of one of those
  int bytes;              ///< of a texel on the GPU
};

FormatInfo format_info(Format format) {
  switch (format) {
    case Format::r32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4, 4};
    case Format::rgb32ui:
      return {GL_RGB32UI, GL_RGB_INTEGER, GL_UNSIGNED_INT, 12, 12};
    case Format::rgba32ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16, 16};
    case Format::r16f:
      return {GL_R16F, GL_RED, GL_FLOAT, 4, 2};
    case Format::rg16f:
      return {GL_RG16F, GL_RG, GL_FLOAT, 8, 4};
    case Format::rgba16f:
      return {GL_RGBA16F, GL_RGBA, GL_FLOAT, 16, 8};
    case Format::r32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 4, 4};
    case Format::rg32f:
      return {GL_RG32F, GL_RG, GL_FLOAT, 8, 8};
    case Format::rgb32f:
      return {GL_RGB32F, GL_RGB, GL_FLOAT, 12, 12};
    case Format::rgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16, 16};
    case Format::srgb8_alpha8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, 4};
    case Format::depth32f:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4, 4};
    case Format::rgba8:
      return {GL_RGBA8, GL_RGBA, GL_FLOAT, 16, 4};
    case Format::depth32f_stencil8:
      return {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 8, 8};
  }
  assert(false);
  return {};
}

GLuint create(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return name;
}

void set_filter(GLuint name, GLenum between_texels, GLenum between_levels) {
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(between_texels));
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(between_levels));
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

}  // namespace

void delete_texture(unsigned name) {
  glDeleteTextures(1, &name);
}

void unbind_textures() {
  GLint units = 0, images = 0;
  glGetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &units);
  glGetIntegerv(GL_MAX_IMAGE_UNITS, &images);
  glBindTextures(0, units, nullptr);
  glBindImageTextures(0, images, nullptr);
}

bool is_float(Format format) {
  const GLenum type = format_info(format).type;
  return type != GL_UNSIGNED_INT;
}

Texture::Texture(Format format, glm::ivec2 size, int layers, int levels)
    : Texture(layers == 1 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY, format, glm::ivec3(size, layers), levels) {}

Texture Texture::array(Format format, glm::ivec2 size, int layers) {
  return {GL_TEXTURE_2D_ARRAY, format, glm::ivec3(size, layers), 1};
}

Texture Texture::volume(Format format, glm::ivec3 size, int levels) {
  return {GL_TEXTURE_3D, format, size, levels};
}

Texture::Texture(unsigned target, Format format, glm::ivec3 size, int levels)
    : handle_(create(target)),
      format_(format),
      size_(size),
      is_volume_(target == GL_TEXTURE_3D),
      is_image_(target == GL_TEXTURE_2D),
      levels_(levels) {
  const GLenum internal_format = format_info(format).internal_format;
  if (target == GL_TEXTURE_2D) {
    glTextureStorage2D(name(), levels, internal_format, size.x, size.y);
  } else {
    glTextureStorage3D(name(), levels, internal_format, size.x, size.y, size.z);
  }
  require_allocated(bytes());
  set_filter(name(), GL_NEAREST, GL_NEAREST_MIPMAP_NEAREST);
}

glm::ivec3 Texture::extent(int level) const {
  const glm::ivec3 halved = glm::max(size_ >> level, glm::ivec3(1));
  return {halved.x, halved.y, is_volume_ ? halved.z : size_.z};
}

std::int64_t Texture::bytes() const {
  std::int64_t texels = 0;
  for (int level = 0; level < levels_; ++level) {
    const glm::ivec3 size = extent(level);
    texels += std::int64_t{size.x} * size.y * size.z;
  }
  return texels * format_info(format_).bytes;
}

void Texture::sample_linearly(Wrap horizontally) const {
  set_filter(name(), GL_LINEAR, GL_LINEAR_MIPMAP_LINEAR);
  if (horizontally == Wrap::repeat) glTextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_REPEAT);
}

void Texture::sample_as_grey() const {
  glTextureParameteri(name(), GL_TEXTURE_SWIZZLE_G, GL_RED);
  glTextureParameteri(name(), GL_TEXTURE_SWIZZLE_B, GL_RED);
}

void Texture::bind_sampler(unsigned unit) const {
  glBindTextureUnit(unit, name());
}

void Texture::bind_image(unsigned unit, int level) const {
  glBindImageTexture(unit, name(), level, GL_TRUE, 0, GL_READ_WRITE, format_info(format_).internal_format);
}

void Texture::clear() const {
  glClearTexImage(name(), 0, GL_RGBA, GL_FLOAT, nullptr);
}

void Texture::write(const void* values, int level) const {
  const FormatInfo info = format_info(format_);
  const glm::ivec3 size = extent(level);
  if (!is_image_) {
    glTextureSubImage3D(name(), level, 0, 0, 0, size.x, size.y, size.z, info.channels, info.type, values);
  } else {
    glTextureSubImage2D(name(), level, 0, 0, size.x, size.y, info.channels, info.type, values);
  }
}

std::size_t Texture::transfer_bytes() const {
  return static_cast<std::size_t>(format_info(format_).transfer_bytes);
}

void Texture::read_bytes(int level, void* destination, std::size_t bytes) const {
  const FormatInfo info = format_info(format_);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(name(), level, info.channels, info.type, static_cast<GLsizei>(bytes), destination);
}

void Texture::read_row_bytes(int first, int count, void* destination, std::size_t bytes) const {
  const FormatInfo info = format_info(format_);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureSubImage(name(), 0, 0, first, 0, size_.x, count, 1, info.channels, info.type,
                       static_cast<GLsizei>(bytes), destination);
}

TexelView::TexelView(const Limits& limits, const Buffer& buffer, Format format, const std::string& what) {
  const FormatInfo info = format_info(format);
  const std::int64_t texels = buffer.bytes() / info.bytes;
  require_texels(limits, texels, what, "");
  handle_ = Handle<delete_texture>(create(GL_TEXTURE_BUFFER));
  glTextureBuffer(handle_.get(), info.internal_format, buffer.name());
}

void TexelView::bind_sampler(unsigned unit) const {
  glBindTextureUnit(unit, handle_.get());
}

}  // namespace airlight::gpu
