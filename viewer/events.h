#pragma once

#include <deque>
#include <utility>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace airlight::viewer {

// What a person does, as a window tells it, or a script.

struct KeyEvent {
  int key;  ///< GLFW_KEY_…
  bool is_down;
};
struct CharacterEvent {
  unsigned codepoint;
};
struct ButtonEvent {
  int button;  ///< 0 left, 1 right, 2 middle
  bool is_down;
};
struct CursorEvent {
  glm::dvec2 place;  ///< from the window's top left corner, in the units of its size
};
struct ScrollEvent {
  double notches;
};
/// The first one comes before all else.
struct SizeEvent {
  glm::ivec2 size;    ///< of the window; 0 of one that is minimised
  glm::ivec2 pixels;  ///< that it has: more where the screen is a fine one
};
struct FocusEvent {
  bool has_focus;
};
struct CloseEvent {};

using Event = std::variant<KeyEvent, CharacterEvent, ButtonEvent, CursorEvent, ScrollEvent, SizeEvent,
                           FocusEvent, CloseEvent>;

/// Events in their order, handed out frame by frame so that none is lost on who looks at keys and buttons
/// once a frame: what is pressed and released between two frames is down for one of them.
class EventQueue {
 public:
  void push(const Event& event) { events_.push_back(event); }
  bool empty() const { return events_.empty(); }

  /// All, whatever they undo.
  std::deque<Event> take_all() { return std::exchange(events_, {}); }

  /// The next frame's: as many as there are before one that undoes another of them, or moves the cursor away
  /// from where a button went.
  std::vector<Event> take();

 private:
  std::deque<Event> events_;
};

}  // namespace airlight::viewer
