#pragma once

#include <memory>
#include <string>

#include "gpu/context.h"
#include "gpu/texture.h"
#include "viewer/events.h"

namespace airlight::viewer {

/// A window with an OpenGL context, by GLFW. One at a time.
class Window {
 public:
  /// Its context is current on the calling thread afterwards.
  /// @throws scene::Error (driver) where there is no display, or no window with OpenGL 4.5 can be had
  Window(const std::string& title, glm::ivec2 size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Waits for an event, but not longer than that [s]; 0 does not wait. Then all that there are are in
  /// `events`.
  void wait(double seconds);

  EventQueue& events() { return events_; }

  /// Shows an image of its pixels, last row first. @param image rgba8
  void present(const gpu::Texture& image);

  static double seconds();  ///< since GLFW began

  struct State;

 private:
  EventQueue events_;
  std::unique_ptr<State> state_;
};

}  // namespace airlight::viewer
