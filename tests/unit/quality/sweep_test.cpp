#include "quality/sweep.h"

#include <gtest/gtest.h>

namespace airlight::quality {
namespace {

TEST(PairedTimes, AreRatiosOfRoundsNotOfMedians) {
  // The machine slows down threefold in the second half: the pairs do not see it.
  const std::vector<std::vector<double>> times = {{2, 8}, {2, 8}, {2, 8}, {6, 24}, {6, 24}, {6, 24}},
                                         baseline = {{4, 4}, {4, 4}, {4, 4}, {12, 12}, {12, 12}, {12, 12}};
  const std::vector<double> cpu = {1, 2, 3, 4, 5, 6};
  const PairedTime timed = paired_time(times, baseline, cpu);
  EXPECT_EQ(timed.rounds, 6);
  EXPECT_EQ(timed.ratio.median, 10.0 / 8.0);
  EXPECT_EQ(timed.ratio.low, 10.0 / 8.0);
  EXPECT_EQ(timed.ratio.high, 10.0 / 8.0);
  EXPECT_EQ(timed.even_ratio.median, 0.5);
  EXPECT_EQ(timed.odd_ratio.median, 2.0);
  EXPECT_EQ(timed.view_ms, (std::vector<double>{4, 16}));
  EXPECT_EQ(timed.ms, 10.0);
  EXPECT_EQ(timed.baseline_ms, 8.0);
  EXPECT_EQ(timed.cpu_ms, 3.5);
}

TEST(SettingKeys, DependOnEveryValueAndOnNothingElse) {
  const auto key = [](const char* volume, const char* surface, std::optional<int> shadow_map,
                      const char* subject = "s") {
    return key_of(subject, {parse_volumes(volume)[0], parse_surfaces(surface)[0], shadow_map});
  };
  const std::string usual = key("vsv", "shadow-map", 512);
  EXPECT_EQ(key("vsv:alpha=256", "shadow-map", 512), usual);
  EXPECT_NE(key("vsv:alpha=255", "shadow-map", 512), usual);
  EXPECT_NE(key("vsv", "none", 512), usual);
  EXPECT_NE(key("vsv", "shadow-map", 513), usual);
  EXPECT_NE(key("vsv", "shadow-map", std::nullopt), usual);
  EXPECT_NE(key("vsv", "shadow-map", 512, "t"), usual);
}

TEST(SettingKeys, OfASubjectDependOnGeometryAndEveryView) {
  scene::Geometry geometry, moved;
  geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  moved = geometry;
  moved.positions[2].y = 2;
  scene::View view, turned;
  turned.camera.vertical_fov_degrees += 1;
  const std::vector<scene::View> one = {view}, two = {view, view}, other = {view, turned};
  const std::string usual = hash_of_subject(geometry, one);
  EXPECT_EQ(hash_of_subject(geometry, one), usual);
  EXPECT_NE(hash_of_subject(moved, one), usual);
  EXPECT_NE(hash_of_subject(geometry, two), usual);
  EXPECT_NE(hash_of_subject(geometry, other), hash_of_subject(geometry, two));
}

TEST(DistinctSettings, AreEachThereOnceAndInOneShard) {
  std::vector<Setting> settings;
  for (const char* spec : {"vsv", "vsv:alpha=256", "vsv:alpha=128", "vsv:alpha=64", "vsv:alpha=32"})
    settings.push_back({parse_volumes(spec)[0], parse_surfaces("none")[0], 512});
  EXPECT_EQ(distinct_settings("s", settings, {}).size(), 4u);
  EXPECT_EQ(distinct_settings("s", settings, {1, 2}).size() + distinct_settings("s", settings, {2, 2}).size(),
            4u);
}

}  // namespace
}  // namespace airlight::quality
