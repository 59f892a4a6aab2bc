// Materials that cut parts out of their triangles, in what a frame draws.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/cut_outs.h"
#include "support/render.h"

namespace airlight::frame {
namespace {

using tests::half_cut_away, tests::half_wall, tests::whole_wall;

class CutOutsOf : public testing::TestWithParam<bool> {
 protected:
  scene::View view() const {
    scene::View view = tests::view_of_half_wall({96, 64});
    if (GetParam()) view.lights[0] = scene::sun("", {0.2, 0.3, -1}, glm::vec3(10));
    return view;
  }
  FrameImages render(const scene::Geometry& geometry) const {
    return tests::render_vsv(geometry, view(), {.shadow_map = 512, .surface_shadows = true});
  }
};

/// Pixels of which the two images have other values.
std::size_t differences(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::abs(a[i] - b[i]) > 1e-4f * std::abs(b[i]);
  return count;
}

TEST_P(CutOutsOf, AreNeitherSeenNorCastShadows) {
  const FrameImages cut = render(half_cut_away()), small = render(half_wall()), whole = render(whole_wall());
  // An edge made by texels is drawn where a place is interpolated, one of geometry where corners are snapped:
  // at the wall's edge, 64 pixels, the two may fall on other sides of a pixel's centre, and a texel's.
  EXPECT_LE(differences(cut.distance, small.distance), 16u);
  EXPECT_LE(differences(cut.visibility[0], small.visibility[0]), 16u);
  EXPECT_GE(differences(whole.distance, small.distance), 200u);
  EXPECT_GE(differences(whole.visibility[0], small.visibility[0]), 200u);
  const auto rrmse = [&](const FrameImages& image) {
    return quality::airlight_error(quality::channels_of(image.airlight), quality::channels_of(small.airlight))
        .rrmse;
  };
  // A texel of the shadow map at the edge is 1/256 of the wall's distance wide.
  EXPECT_LT(rrmse(cut), 0.01);
  EXPECT_GT(rrmse(whole), 0.05);
}

INSTANTIATE_TEST_SUITE_P(ByALampAndASun, CutOutsOf, testing::Bool());

TEST(CutOuts, AreDrawnWhereTheLampTouchesOneOfThem) {
  // What holds the light is left out of its shadow map, one triangle at a time.
  scene::View view = tests::view_of_half_wall({48, 32});
  view.lights[0].position = {-0.5, 0, -5};
  const FrameImages cut =
      tests::render_vsv(half_cut_away(), view, {.shadow_map = 256, .surface_shadows = true});
  const FrameImages small =
      tests::render_vsv(half_wall(), view, {.shadow_map = 256, .surface_shadows = true});
  EXPECT_LE(differences(cut.visibility[0], small.visibility[0]), 8u);
  EXPECT_LE(differences(cut.distance, small.distance), 8u);
}

}  // namespace
}  // namespace airlight::frame
