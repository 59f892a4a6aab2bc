#pragma once

#include <map>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "gpu/texture.h"
#include "viewer/events.h"

struct ImGuiContext;

namespace airlight::viewer {

/// Dear ImGui on events of our own: the same in a window and without one.
class Gui {
 public:
  Gui();
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Begins a frame. @param events of this frame @param size of the window @param pixels that it has
  /// @param seconds since the frame before
  void begin(std::span<const Event> events, glm::ivec2 size, glm::ivec2 pixels, double seconds);

  /// Draws it over an image of that many pixels, last row first. @param image rgba8
  void draw(const gpu::Texture& image);

  bool wants_mouse() const;     ///< the cursor is over a panel, or holds one of its controls
  bool wants_keyboard() const;  ///< a text is being typed

  /// Where a control lies that has been drawn in the last frame, so that scripts find it.
  struct Place {
    glm::dvec2 from, to;
  };
  /// Notes the last control drawn by the name that it is known by.
  void note(const std::string& name);
  const std::map<std::string, Place>& controls() const { return controls_; }

 private:
  ImGuiContext* context_;
  float scale_ = 0.0f;  ///< that the font was made for
  std::map<std::string, Place> controls_;
};

}  // namespace airlight::viewer
