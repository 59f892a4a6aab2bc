#include "viewer/events.h"

#include <set>

namespace airlight::viewer {

std::vector<Event> EventQueue::take() {
  std::vector<Event> taken;
  std::set<int> keys, buttons;
  while (!events_.empty()) {
    const Event& event = events_.front();
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
      if (!keys.insert(key->key).second) break;
    } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
      if (!buttons.insert(button->button).second) break;
    } else if (std::holds_alternative<CursorEvent>(event)) {
      if (!buttons.empty()) break;
    }
    taken.push_back(event);
    events_.pop_front();
  }
  return taken;
}

}  // namespace airlight::viewer
