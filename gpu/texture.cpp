#include "gpu/texture.h"

#include <cassert>

#include <fmt/format.h>

#include "scene/error.h"

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

struct FormatInfo {
  GLenum internal_format, format, type;
  int channels;
};

FormatInfo format_info(Format format) {
  switch (format) {
    case Format::r32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 1};
    case Format::rgb32ui:
      return {GL_RGB32UI, GL_RGB_INTEGER, GL_UNSIGNED_INT, 3};
    case Format::rgba32ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 4};
    case Format::rg32f:
      return {GL_RG32F, GL_RG, GL_FLOAT, 2};
    case Format::rgb32f:
      return {GL_RGB32F, GL_RGB, GL_FLOAT, 3};
    case Format::r32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 1};
    case Format::rgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 4};
    case Format::depth32f:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 1};
  }
  assert(false);
  return {};
}

}  // namespace

void delete_texture(unsigned name) {
  glDeleteTextures(1, &name);
}
void delete_framebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}

Texture::Texture(Format format, glm::ivec2 size, int layers) : format_(format), size_(size), layers_(layers) {
  GLuint name = 0;
  const GLenum internal_format = format_info(format).internal_format;
  if (layers == 1) {
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, internal_format, size.x, size.y);
  } else {
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    glTextureStorage3D(name, 1, internal_format, size.x, size.y, layers);
  }
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  handle_ = Handle<delete_texture>(name);
}

std::int64_t Texture::bytes() const {
  return std::int64_t{4} * format_info(format_).channels * size_.x * size_.y * layers_;
}

void Texture::sample_bilinearly_around() const {
  glTextureParameteri(name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void Texture::sample_as_grey() const {
  glTextureParameteri(name(), GL_TEXTURE_SWIZZLE_G, GL_RED);
  glTextureParameteri(name(), GL_TEXTURE_SWIZZLE_B, GL_RED);
}

void Texture::bind_sampler(unsigned unit) const {
  glBindTextureUnit(unit, name());
}

void Texture::bind_image(unsigned unit) const {
  glBindImageTexture(unit, name(), 0, GL_FALSE, 0, GL_READ_WRITE, format_info(format_).internal_format);
}

void Texture::write(const void* values) const {
  const FormatInfo info = format_info(format_);
  glTextureSubImage2D(name(), 0, 0, 0, size_.x, size_.y, info.format, info.type, values);
}

void Texture::read_bytes(void* destination, std::size_t bytes) const {
  const FormatInfo info = format_info(format_);
  assert(layers_ == 1 && bytes == static_cast<std::size_t>(this->bytes()));
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(name(), 0, info.format, info.type, static_cast<GLsizei>(bytes), destination);
}

TexelView::TexelView(const Context& context, const Buffer& buffer, Format format, const std::string& what) {
  const FormatInfo info = format_info(format);
  const std::int64_t texels = buffer.bytes() / (4 * info.channels);
  require_texels(context.limits(), texels, what, "");
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
  handle_ = Handle<delete_texture>(name);
  glTextureBuffer(name, info.internal_format, buffer.name());
}

void TexelView::bind_sampler(unsigned unit) const {
  glBindTextureUnit(unit, handle_.get());
}

Framebuffer::Framebuffer(const Texture* colour, const Texture& depth, int depth_layer)
    : size_(depth.size()), has_colour_(colour != nullptr) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  handle_ = Handle<delete_framebuffer>(name);
  if (colour) {
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, colour->name(), 0);
    glNamedFramebufferDrawBuffer(name, GL_COLOR_ATTACHMENT0);
  } else {
    glNamedFramebufferDrawBuffer(name, GL_NONE);
  }
  if (depth.layers() == 1) {
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth.name(), 0);
  } else {
    glNamedFramebufferTextureLayer(name, GL_DEPTH_ATTACHMENT, depth.name(), 0, depth_layer);
  }
  assert(glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
}

void Framebuffer::begin() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, handle_.get());
  glViewport(0, 0, size_.x, size_.y);
  // Reversed depth, near / z, keeps a relative precision of 2^-24 at any distance.
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  // What is nearer than the near plane is kept, at its depth: an occluder must not vanish.
  glEnable(GL_DEPTH_CLAMP);
  const GLfloat far_depth = 0.0f;
  glClearNamedFramebufferfv(handle_.get(), GL_DEPTH, 0, &far_depth);
  if (has_colour_) {
    const GLuint nothing[4] = {0, 0, 0, 0};
    glClearNamedFramebufferuiv(handle_.get(), GL_COLOR, 0, nothing);
  }
}

}  // namespace airlight::gpu
