#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/handle.h"

namespace airlight::gpu {

void delete_buffer(unsigned name);
void delete_vertex_array(unsigned name);

/// @throws scene::Error (driver) where OpenGL has just failed to find so many bytes
void require_allocated(std::int64_t bytes);

/// Immutable storage on the GPU. Never of size 0 for the driver: an empty buffer holds four unused bytes.
class Buffer {
 public:
  Buffer() = default;

  /// @param data initial contents, or nullptr for zeros; `bytes` of them
  /// @throws scene::Error (driver) when there is no memory for it.
  explicit Buffer(std::int64_t bytes, const void* data = nullptr);

  template <typename T>
  static Buffer from(std::span<const T> values) {
    return Buffer(static_cast<std::int64_t>(values.size_bytes()), values.data());
  }

  unsigned name() const { return handle_.get(); }
  std::int64_t bytes() const { return bytes_; }

  void bind_storage(unsigned binding) const;                                           ///< as shader storage
  void bind_storage(unsigned binding, std::int64_t offset, std::int64_t bytes) const;  ///< a part of it
  void bind_uniform(unsigned binding) const;                                           ///< as a uniform block

  void write(const void* data, std::int64_t bytes) const;  ///< from offset 0; the buffer must be that large
  void clear(std::uint32_t word = 0) const;                ///< every word of it

  /// Waits for the GPU and copies the contents back.
  template <typename T>
  std::vector<T> read() const {
    std::vector<T> values(static_cast<std::size_t>(bytes_) / sizeof(T));
    read_bytes(0, bytes_, values.data());
    return values;
  }

  /// The same of `count` values from number `first` on.
  template <typename T>
  std::vector<T> read(std::int64_t first, std::int64_t count) const {
    std::vector<T> values(static_cast<std::size_t>(count));
    constexpr auto k_bytes = static_cast<std::int64_t>(sizeof(T));
    read_bytes(first * k_bytes, count * k_bytes, values.data());
    return values;
  }

 private:
  void read_bytes(std::int64_t offset, std::int64_t bytes, void* destination) const;

  Handle<delete_buffer> handle_;
  std::int64_t bytes_ = 0;
};

}  // namespace airlight::gpu
