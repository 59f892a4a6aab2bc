#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/handle.h"

namespace airlight::gpu {

void delete_texture(unsigned name);

/// The formats in use, as OpenGL's sized internal formats.
enum class Format {
  r32ui,
  rgb32ui,
  rgba32ui,
  r16f,
  rg16f,
  rgba16f,
  r32f,
  rg32f,
  rgb32f,
  rgba32f,
  srgb8_alpha8,
  depth32f,
  depth32f_stencil8,
  rgba8,  ///< colours from 0 to 1, as windows have them
};

/// Leaves no texture bound for sampling or as an image.
void unbind_textures();

/// Whether its values are floating-point numbers, of colour or of depth.
bool is_float(Format format);

/// A texel of Format::depth32f_stencil8, as it is written and read.
struct DepthStencil {
  float depth;
  std::uint32_t stencil;  ///< its low 8 bits
};

/// What samplers do beyond the sides of a texture, left and right.
enum class Wrap { clamp, repeat };

/// An image, a stack of them (layers), or a volume; each level has half the size of the one before it.
/// Samplers take the nearest texel of the nearest level unless told otherwise.
class Texture {
 public:
  Texture() = default;

  /// An image, sampled as a 2D texture; with more than one layer as an array of them.
  Texture(Format format, glm::ivec2 size, int layers = 1, int levels = 1);

  /// An array of any number of layers, one included.
  static Texture array(Format format, glm::ivec2 size, int layers);

  /// A 3D texture.
  static Texture volume(Format format, glm::ivec3 size, int levels = 1);

  unsigned name() const { return handle_.get(); }
  Format format() const { return format_; }
  int levels() const { return levels_; }
  int layers() const { return is_volume_ ? 1 : size_.z; }
  glm::ivec2 size(int level = 0) const { return extent(level); }
  glm::ivec3 extent(int level = 0) const;  ///< of a level: width, height, and layers or depth [texels]
  std::int64_t bytes() const;              ///< of all levels

  /// From now on samplers interpolate between texels and between levels. llvmpipe does so in single
  /// precision; a GPU may round the weights to 1/256.
  void sample_linearly(Wrap horizontally = Wrap::clamp) const;

  /// From now on samplers see the red channel in green and blue, too.
  void sample_as_grey() const;

  void bind_sampler(unsigned unit) const;
  void bind_image(unsigned unit, int level = 0) const;  ///< for reads and writes, with all layers

  /// Zeros in the first level.
  void clear() const;

  /// Writes a level. @param values as `read` returns them
  void write(const void* values, int level = 0) const;

  /// Waits for the GPU and copies a level back.
  /// @tparam T one texel: as many channels as the format has, in 32 bits also where the format has 16, of
  /// srgb8_alpha8 in 8, encoded; or DepthStencil
  /// @returns row 0 first, layer after layer
  template <typename T>
  std::vector<T> read(int level = 0) const {
    assert(sizeof(T) == transfer_bytes());
    const glm::ivec3 size = extent(level);
    std::vector<T> values(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                          static_cast<std::size_t>(size.z));
    read_bytes(level, values.data(), values.size() * sizeof(T));
    return values;
  }

  /// As `read`, of some rows of an image's first level.
  /// @param values room for `count` rows
  template <typename T>
  void read_rows(int first, int count, T* values) const {
    assert(sizeof(T) == transfer_bytes());
    read_row_bytes(first, count, values,
                   static_cast<std::size_t>(count) * static_cast<std::size_t>(size_.x) * sizeof(T));
  }

 private:
  /// @param target GL_TEXTURE_2D, …_2D_ARRAY or …_3D
  /// @param size   width, height, and layers or depth
  Texture(unsigned target, Format format, glm::ivec3 size, int levels);

  std::size_t transfer_bytes() const;  ///< of a texel that is written or read
  void read_row_bytes(int first, int count, void* destination, std::size_t bytes) const;
  void read_bytes(int level, void* destination, std::size_t bytes) const;

  Handle<delete_texture> handle_;
  Format format_{};
  glm::ivec3 size_{0};
  bool is_volume_ = false;
  bool is_image_ = false;  ///< no array and no volume
  int levels_ = 0;
};

/// A buffer seen through a sampler (usamplerBuffer, samplerBuffer): what shaders only read, they read this
/// way. llvmpipe fetches texels ten times faster than it loads from storage blocks; on a GPU the two cost the
/// same.
class TexelView {
 public:
  TexelView() = default;

  /// @throws scene::Error (driver) when the buffer has more texels than `limits` allows.
  TexelView(const Limits& limits, const Buffer& buffer, Format format, const std::string& what);

  void bind_sampler(unsigned unit) const;

 private:
  Handle<delete_texture> handle_;
};

}  // namespace airlight::gpu
