#include "surface_shadows/shadow_map_lookup.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "frame/frame.h"
#include "frame/none.h"
#include "reference/reference.h"
#include "support/gpu_context.h"
#include "support/scenes.h"

namespace airlight::surface_shadows {
namespace {

using tests::builtin;
using tests::view_of;

struct Wrong {
  std::size_t pixels, wrong;
};

frame::FrameImages look_up(const scene::Geometry& geometry, const scene::View& view, int shadow_map_size) {
  frame::Frame frame(tests::gpu_context(), geometry, shadow_map_size);
  ShadowMapLookup lookup;
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(nullptr);
  frame.render(view, lookup, no_airlight, timer);
  return frame.read();
}

/// Pixels that see a surface, and those among them that are lit here and dark there.
Wrong compare(const scene::Geometry& geometry, const scene::View& view, int shadow_map_size) {
  const frame::FrameImages images = look_up(geometry, view, shadow_map_size);
  const reference::SurfaceImage exact = reference::Reference(geometry, view).surfaces();
  Wrong count{0, 0};
  for (std::size_t i = 0; i < images.distance.size(); ++i) {
    if (images.distance[i] == 0.0f || exact.distance[i] == 0.0f) continue;
    ++count.pixels;
    count.wrong += images.visibility[0][i] != exact.visibility[i];
  }
  return count;
}

class ShadowMapLookupOf : public testing::TestWithParam<const char*> {};

TEST_P(ShadowMapLookupOf, IsWrongOnlyWithinATexelOfAnEdge) {
  const scene::Scene& scene = builtin(GetParam());
  const Wrong coarse = compare(scene.geometry, view_of(scene, {128, 128}), 256);
  const Wrong fine = compare(scene.geometry, view_of(scene, {128, 128}), 2048);
  RecordProperty("coarse",
                 std::to_string(static_cast<double>(coarse.wrong) / static_cast<double>(coarse.pixels)));
  RecordProperty("fine", std::to_string(static_cast<double>(fine.wrong) / static_cast<double>(fine.pixels)));
  EXPECT_LE(fine.wrong, coarse.wrong);
  EXPECT_LE(static_cast<double>(fine.wrong), 0.02 * static_cast<double>(fine.pixels))
      << "no acne, no missing shadow";
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadowMapLookupOf,
                         testing::Values("cornell", "window", "sphere", "half-space"));

TEST(ShadowMapLookup, ALonePlaneIsLitWhollyAtAnySlope) {
  for (double height : {5.0, 0.5, 0.05}) {
    const Wrong count = compare(tests::level_plane(50), tests::view_of_level_plane({1, height, -1}), 512);
    EXPECT_EQ(count.wrong, 0u) << "of " << count.pixels << " with the light at " << height;
  }
}

TEST(ShadowMapLookup, ALonePlaneIsDarkWhereItPartsEyeAndLight) {
  for (double depth : {5.0, 0.5, 0.05}) {
    // Coarse: the map alone would let light through.
    const std::vector<float> visibility =
        look_up(tests::level_plane(50), tests::view_of_level_plane({1, -depth, -1}), 64).visibility[0];
    EXPECT_EQ(std::count(visibility.begin(), visibility.end(), 0.0f), 64 * 64) << depth;
  }
}

}  // namespace
}  // namespace airlight::surface_shadows
