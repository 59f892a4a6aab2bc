#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/handle.h"

namespace airlight::gpu {

void delete_texture(unsigned name);
void delete_framebuffer(unsigned name);

/// The formats in use, as OpenGL's sized internal formats.
enum class Format : unsigned { r32ui, rgb32ui, rgba32ui, r32f, rg32f, rgb32f, rgba32f, depth32f };

/// A 2D texture, or an array of them, with one level and nearest sampling unless told otherwise.
class Texture {
 public:
  Texture() = default;
  Texture(Format format, glm::ivec2 size, int layers = 1);

  unsigned name() const { return handle_.get(); }
  Format format() const { return format_; }
  glm::ivec2 size() const { return size_; }
  int layers() const { return layers_; }
  std::int64_t bytes() const;

  /// From now on samplers interpolate between texels, around the sides, not over the top and the bottom.
  /// llvmpipe does so in single precision; a GPU may round the weights to 1/256.
  void sample_bilinearly_around() const;

  /// From now on samplers see the red channel in green and blue, too.
  void sample_as_grey() const;

  void bind_sampler(unsigned unit) const;
  void bind_image(unsigned unit) const;  ///< for reads and writes

  /// Writes layer 0. @param values 32-bit values, row 0 first, as many channels as the format has
  void write(const void* values) const;

  /// Waits for the GPU and copies layer 0 back: 32-bit values, as many channels as the format has.
  template <typename T>
  std::vector<T> read() const {
    static_assert(sizeof(T) % 4 == 0);
    std::vector<T> values(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
    read_bytes(values.data(), values.size() * sizeof(T));
    return values;
  }

 private:
  void read_bytes(void* destination, std::size_t bytes) const;

  Handle<delete_texture> handle_;
  Format format_{};
  glm::ivec2 size_{0};
  int layers_ = 0;
};

/// A buffer seen through a sampler (usamplerBuffer, samplerBuffer): what shaders only read, they read this
/// way. llvmpipe fetches texels ten times faster than it loads from storage blocks; on a GPU the two cost the
/// same.
class TexelView {
 public:
  TexelView() = default;

  /// @throws scene::Error (driver) when the buffer has more texels than the driver allows.
  TexelView(const Context& context, const Buffer& buffer, Format format, const std::string& what);

  void bind_sampler(unsigned unit) const;

 private:
  Handle<delete_texture> handle_;
};

/// A set of attachments to draw into.
class Framebuffer {
 public:
  Framebuffer() = default;

  /// @param colour may be nullptr; @param depth_layer which layer of `depth` to draw into
  Framebuffer(const Texture* colour, const Texture& depth, int depth_layer);

  /// Makes it the target, with a viewport over all of it. Depth runs from 1 (near) to 0 (infinity).
  void begin() const;

 private:
  Handle<delete_framebuffer> handle_;
  glm::ivec2 size_{0};
  bool has_colour_ = false;
};

}  // namespace airlight::gpu
