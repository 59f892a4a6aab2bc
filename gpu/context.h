#pragma once

#include <cstdint>
#include <string>

namespace airlight::gpu {

/// What this driver allows; queried, never assumed.
struct Limits {
  std::int64_t max_storage_block_bytes;  ///< size of one shader storage buffer
  std::int64_t max_texel_buffer_texels;  ///< of a buffer seen through a sampler
  int max_texture_size;                  ///< of a 2D texture's side [texels]
  int max_viewport;                      ///< of an image's side [pixels]
  int max_array_layers;
  int max_work_group_invocations;
  int storage_offset_alignment;  ///< of a range of a buffer bound as shader storage [bytes]
};

struct Device {
  std::string renderer;
  std::string version;
  bool is_software;  ///< the driver runs on the CPU (llvmpipe, softpipe)
};

/// A headless OpenGL 4.5 core context, current on the thread that made it; one at a time.
///
/// A hardware device is taken where EGL lists one that can; else Mesa's surfaceless platform.
/// Debug messages of high severity are collected as errors from the start: see `check`.
class Context {
 public:
  /// @throws scene::Error (driver) where no OpenGL 4.5 core context with SPIR-V shaders can be had.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Device& device() const { return device_; }
  const Limits& limits() const { return limits_; }

  /// @throws scene::Error (driver) with the driver's words, if it sent a message of high severity since the
  /// last check.
  void check();

  /// Waits until the GPU has done all work, then checks.
  void finish();

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  Device device_;
  Limits limits_{};
  std::string errors_;
};

/// @throws scene::Error (driver) naming the limit when `bytes` is more than one shader storage buffer may
/// hold.
void require_storage_block(const Limits& limits, std::int64_t bytes, const std::string& what,
                           const std::string& remedy);

/// @throws scene::Error (driver) naming the limit when `texels` are more than a buffer seen through a sampler
/// may hold.
void require_texels(const Limits& limits, std::int64_t texels, const std::string& what,
                    const std::string& remedy);

}  // namespace airlight::gpu
