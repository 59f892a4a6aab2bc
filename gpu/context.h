#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include <glm/glm.hpp>

namespace airlight::gpu {

/// What this driver allows; queried, never assumed.
struct Limits {
  std::int64_t max_storage_block_bytes;  ///< size of one shader storage buffer
  std::int64_t max_texel_buffer_texels;  ///< of a buffer seen through a sampler
  int max_texture_size;                  ///< of a 2D texture's side [texels]
  int max_volume_size;                   ///< of a 3D texture's side [texels]
  int max_viewport;                      ///< of an image's side [pixels]
  int max_array_layers;
  int max_work_group_invocations;
  glm::uvec3 max_work_groups;    ///< of one dispatch, along each axis
  int storage_offset_alignment;  ///< of a range of a buffer bound as shader storage [bytes]
};

struct Device {
  std::string renderer;
  std::string version;
  bool is_software;  ///< the driver runs on the CPU
};

/// Whether a renderer's name is that of a driver that runs on the CPU.
bool is_software_renderer(const std::string& renderer);

/// When the driver hands over its debug messages.
enum class DebugOutput {
  asynchronous,  ///< when it likes, from any thread: costs nothing
  synchronous,  ///< within the call that is to blame, so that a debugger stops there: slows some drivers down
};

/// An OpenGL 4.5 core context, current on the thread that made it; one at a time.
///
/// Debug messages of high severity are collected as errors from the start: see `check`.
class Context {
 public:
  /// Makes a context without a window. A hardware device is taken where EGL lists one that can; else Mesa's
  /// surfaceless platform.
  /// @throws scene::Error (driver) where no OpenGL 4.5 core context with SPIR-V shaders can be had.
  explicit Context(DebugOutput debug_output = DebugOutput::asynchronous);

  /// Takes the context that somebody else has made current, such as a window's, and leaves it to them; it
  /// must outlive this. Without a debug context, drivers may keep their mistakes to themselves.
  /// @throws scene::Error (driver) where it is not OpenGL 4.5 with SPIR-V shaders.
  static Context adopt_current(DebugOutput debug_output = DebugOutput::asynchronous);

  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Device& device() const { return device_; }
  const Limits& limits() const { return limits_; }

  /// @throws scene::Error (driver) with the driver's words, if it sent a message of high severity since the
  /// last check. Of work that the GPU has not done yet, it may not have sent it yet.
  void check();

  /// Waits until the GPU has done all work, then checks.
  void finish();

 private:
  struct Errors {
    std::mutex mutex;
    std::string text;
  };
  struct Adopted {};

  Context(Adopted, DebugOutput debug_output);
  void set_up(DebugOutput debug_output);
  static void collect(unsigned source, unsigned type, unsigned id, unsigned severity, int length,
                      const char* message, const void* errors);

  void* display_ = nullptr;  ///< of a context of our own
  void* context_ = nullptr;
  Device device_;
  Limits limits_{};
  Errors errors_;
};

/// @throws scene::Error (driver) naming the limit when `bytes` is more than one shader storage buffer may
/// hold.
void require_storage_block(const Limits& limits, std::int64_t bytes, const std::string& what,
                           const std::string& remedy);

/// @throws scene::Error (driver) naming the limit when `texels` are more than a buffer seen through a sampler
/// may hold.
void require_texels(const Limits& limits, std::int64_t texels, const std::string& what,
                    const std::string& remedy);

/// How many work groups the current context takes in one dispatch, along each axis.
glm::uvec3 max_work_groups();

/// @throws scene::Error (driver) naming the limit when `groups` are more than `most` along any axis.
void require_work_groups(glm::uvec3 most, glm::uvec3 groups);

}  // namespace airlight::gpu
