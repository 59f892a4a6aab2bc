#include "gpu/framebuffer.h"

#include <string>

#include <fmt/format.h>

#include "scene/error.h"

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

void attach(GLuint framebuffer, GLenum point, const Attachment& attachment) {
  const GLuint texture = attachment.texture->name();
  if (attachment.layer) {
    glNamedFramebufferTextureLayer(framebuffer, point, texture, attachment.level, *attachment.layer);
  } else {
    glNamedFramebufferTexture(framebuffer, point, texture, attachment.level);
  }
}

std::string status_name(GLenum status) {
  switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
      return "GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
      return "GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT";
    case GL_FRAMEBUFFER_UNSUPPORTED:
      return "GL_FRAMEBUFFER_UNSUPPORTED";
    case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
      return "GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS";
    default:
      return fmt::format("status {:#x}", status);
  }
}

}  // namespace

void delete_framebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}

Framebuffer::Framebuffer(const std::vector<Attachment>& colours, const std::optional<Attachment>& depth) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  handle_ = Handle<delete_framebuffer>(name);
  std::vector<GLenum> outputs;
  for (const Attachment& colour : colours) {
    outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size()));
    attach(name, outputs.back(), colour);
    colour_is_float_.push_back(is_float(colour.texture->format()));
    size_ = colour.texture->size(colour.level);
  }
  glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(outputs.size()), outputs.data());
  if (depth) {
    has_depth_ = true;
    has_stencil_ = depth->texture->format() == Format::depth32f_stencil8;
    attach(name, has_stencil_ ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, *depth);
    size_ = depth->texture->size(depth->level);
  }
  const GLenum status = glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw scene::Error(scene::ExitCode::driver, "framebuffer",
                       "the driver cannot draw into it: " + status_name(status));
  }
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, handle_.get());
  glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::clear(float depth, int stencil) const {
  for (std::size_t i = 0; i < colour_is_float_.size(); ++i) {
    const GLfloat no_light[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    const GLuint nothing[4] = {0, 0, 0, 0};
    if (colour_is_float_[i]) {
      glClearNamedFramebufferfv(handle_.get(), GL_COLOR, static_cast<GLint>(i), no_light);
    } else {
      glClearNamedFramebufferuiv(handle_.get(), GL_COLOR, static_cast<GLint>(i), nothing);
    }
  }
  if (has_depth_) glClearNamedFramebufferfv(handle_.get(), GL_DEPTH, 0, &depth);
  if (has_stencil_) glClearNamedFramebufferiv(handle_.get(), GL_STENCIL, 0, &stencil);
}

void stretch(const Texture& image, const Region& part, const Texture& over, const Region& over_part,
             bool smoothly) {
  const Framebuffer source({image}), target({over});
  glBlitNamedFramebuffer(source.name(), target.name(), part.from.x, part.from.y, part.to.x, part.to.y,
                         over_part.from.x, over_part.from.y, over_part.to.x, over_part.to.y,
                         GL_COLOR_BUFFER_BIT, smoothly ? GL_LINEAR : GL_NEAREST);
}

}  // namespace airlight::gpu
