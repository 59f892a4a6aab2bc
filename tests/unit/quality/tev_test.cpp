#include "quality/tev.h"

#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quality/pictures.h"
#include "scene/error.h"
#include "support/tev_listener.h"

namespace airlight::quality {
namespace {

frame::FrameImages some_images(glm::ivec2 size) {
  frame::FrameImages images;
  images.size = size;
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto value = static_cast<float>(i);
    images.radiance.emplace_back(value, value + 0.25f, value + 0.5f);
    images.airlight.emplace_back(2.0f * value);
    images.distance.push_back(-value);
  }
  images.lights = {"a", "b"};
  images.is_skipped = {false, false};
  images.airlight_of_light = {images.airlight, images.airlight};
  images.visibility = {std::vector<float>(pixels, 1.0f), std::vector<float>(pixels, 0.0f)};
  return images;
}

TEST(Tev, IsShownEveryLayerOfAnImage) {
  tests::TevListener viewer;
  std::thread listening([&] { viewer.listen_to_all(); });
  const frame::FrameImages images = some_images({700, 800});  // several packets a channel
  {
    Tev tev(viewer.address);
    tev.show("first", some_images({2, 1}));
    tev.show("second", images);
    EXPECT_TRUE(tev.is_there());
  }
  listening.join();
  ASSERT_EQ(viewer.shown.size(), 2u);
  const tests::TevListener::Shown& shown = viewer.shown.at("second");
  EXPECT_EQ(shown.width, 700);
  EXPECT_EQ(shown.height, 800);
  const FrameLayers layers(images);
  ASSERT_EQ(shown.channels.size(), layers.channels().size());
  for (const auto& [name, layer] : layers.channels()) {
    const std::vector<float>& values = shown.channels.at(name);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < values.size(); ++i) wrong += values[i] != layer.first[i * layer.step];
    EXPECT_EQ(wrong, 0u) << name;
  }
  EXPECT_EQ(shown.channels.at("surface.Y")[5], 0.5f);
}

TEST(Tev, MayBeClosedWhileImagesAreShown) {
  tests::TevListener viewer;
  std::thread listening([&] { viewer.listen_to_all(1); });
  Tev tev(viewer.address);
  tev.show("first", some_images({2, 1}));
  listening.join();
  viewer.stop_listening();
  for (int i = 0; i < 100 && tev.is_there(); ++i) tev.show("second", some_images({700, 800}));
  EXPECT_FALSE(tev.is_there());
  tev.show("third", some_images({2, 1}));
}

TEST(Tev, IsMissedByName) {
  const auto said_of = [](const std::string& address) -> std::string {
    try {
      const Tev tev(address);
    } catch (const scene::Error& error) {
      return fmt::format("{} {}", static_cast<int>(error.exit_code), error.what());
    }
    return "nothing";
  };
  tests::TevListener viewer;
  viewer.stop_listening();
  EXPECT_THAT(said_of(viewer.address), testing::StartsWith("3 --tev: no tev answers at " + viewer.address));
  for (const char* none : {"", "14158", ":14158", "localhost:"})
    EXPECT_THAT(said_of(none), testing::StartsWith("2 --tev: ")) << none;
}

}  // namespace
}  // namespace airlight::quality
