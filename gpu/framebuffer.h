#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/handle.h"
#include "gpu/texture.h"

namespace airlight::gpu {

void delete_framebuffer(unsigned name);

/// A level of a texture to draw into.
struct Attachment {
  // Not explicit: a texture stands for its first level.
  Attachment(const Texture& attached, int its_level = 0, std::optional<int> its_layer = {})
      : texture(&attached), level(its_level), layer(its_layer) {}
  const Texture* texture;
  int level;
  std::optional<int> layer;  ///< none: all of them, told apart by gl_Layer
};

/// A set of attachments to draw into.
class Framebuffer {
 public:
  Framebuffer() = default;

  /// @param colours in the order of the fragment shader's outputs
  /// @param depth   a depth format, with or without stencil
  /// @throws scene::Error (driver) naming the status when OpenGL calls the set incomplete.
  explicit Framebuffer(const std::vector<Attachment>& colours, const std::optional<Attachment>& depth = {});

  /// Makes it the target of draws, with a viewport over all of it.
  void bind() const;

  unsigned name() const { return handle_.get(); }

  /// Sets colours to 0, and depth and stencil to what is given.
  void clear(float depth = 0.0f, int stencil = 0) const;

 private:
  Handle<delete_framebuffer> handle_;
  glm::ivec2 size_{0};
  std::vector<bool> colour_is_float_;
  bool has_depth_ = false, has_stencil_ = false;
};

/// A part of an image, from one corner to the opposite one [texels]; turned over where `to` lies before
/// `from`.
struct Region {
  glm::ivec2 from, to;
};

/// Copies a part of a colour image over a part of another, stretched to fit it.
/// @param smoothly interpolated between texels, else of the nearest
void stretch(const Texture& image, const Region& part, const Texture& over, const Region& over_part,
             bool smoothly);

}  // namespace airlight::gpu
