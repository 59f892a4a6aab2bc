#include "viewer/events.h"

#include <gtest/gtest.h>

namespace airlight::viewer {
namespace {

TEST(EventQueues, LoseNoKeyThatIsPressedAndReleasedBetweenFrames) {
  EventQueue queue;
  queue.push(KeyEvent{65, true});
  queue.push(KeyEvent{66, true});
  queue.push(KeyEvent{65, false});
  queue.push(KeyEvent{66, false});
  EXPECT_EQ(queue.take().size(), 2u);  // both down
  EXPECT_EQ(queue.take().size(), 2u);  // both up
  EXPECT_TRUE(queue.take().empty());
}

TEST(EventQueues, ClickWhereTheCursorIs) {
  EventQueue queue;
  queue.push(CursorEvent{{10, 10}});
  queue.push(CursorEvent{{20, 10}});
  queue.push(ButtonEvent{0, true});
  queue.push(CursorEvent{{30, 10}});
  queue.push(ButtonEvent{0, false});
  const auto down = queue.take();
  ASSERT_EQ(down.size(), 3u);  // the move away waits
  EXPECT_TRUE(std::holds_alternative<ButtonEvent>(down[2]));
  const auto up = queue.take();
  ASSERT_EQ(up.size(), 2u);
  EXPECT_EQ(std::get<CursorEvent>(up[0]).place, glm::dvec2(30, 10));
}

TEST(EventQueues, TellApartClicksOfTwo) {
  EventQueue queue;
  for (int i = 0; i < 2; ++i) {
    queue.push(ButtonEvent{0, true});
    queue.push(ButtonEvent{0, false});
  }
  int frames = 0;
  while (!queue.empty()) {
    EXPECT_EQ(queue.take().size(), 1u);
    ++frames;
  }
  EXPECT_EQ(frames, 4);
}

}  // namespace
}  // namespace airlight::viewer
