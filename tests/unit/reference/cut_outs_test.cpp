#include "reference/cut_outs.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reference/surface_judge.h"
#include "scene/error.h"
#include "support/cut_outs.h"
#include "unit/reference/fixtures.h"

namespace airlight::reference {
namespace {

using scene::TextureWrap;

/// A triangle of 8×6 texels of any alpha, at places of which some lie beyond the image.
scene::Geometry speckled_triangle(airlight::tests::Random& random, std::array<TextureWrap, 2> wrap) {
  scene::Geometry geometry;
  tests::add_triangle(geometry, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  scene::TextureImage& image = geometry.textures.emplace_back();
  image.size = {8, 6};
  for (int i = 0; i < 48; ++i)
    image.texels.emplace_back(0, 0, 0, static_cast<std::uint8_t>(random.uniform(0.0, 255.99)));
  geometry.texture_places = {{{{-1.3f, 0.2f}, {2.1f, -0.4f}, {0.4f, 1.7f}}}};
  geometry.materials[0] = {.wrap = wrap, .cut_out = scene::CutOut{0, 0.5f}};
  return geometry;
}

class CutOutsBeyond : public testing::TestWithParam<TextureWrap> {};

TEST_P(CutOutsBeyond, FindTheVeryPartsOfASegment) {
  airlight::tests::Random random(3);
  const CutOuts cut_outs(speckled_triangle(random, {GetParam(), TextureWrap::mirror}));
  std::vector<CutOuts::Part> parts;
  std::size_t edges = 0;
  for (int segment = 0; segment < 300; ++segment) {
    const auto weights = [&] {
      const double a = random.uniform(0.0, 1.0), b = random.uniform(0.0, 1.0);
      return a + b > 1.0 ? glm::dvec3(1.0 - a, 1.0 - b, a + b - 1.0) : glm::dvec3(a, b, 1.0 - a - b);
    };
    const glm::dvec3 from = weights(), to = weights();
    cut_outs.find_parts(0, from, to, parts);
    const auto is_there = [&](double s) { return cut_outs.is_there(0, glm::mix(from, to, s)); };
    double last = 0.0;
    for (const auto& [begin, end] : parts) {
      ASSERT_TRUE(begin < end && last <= begin && end <= 1.0);
      // An edge is where what is there changes: to the rounding of roots that lie close together.
      constexpr double k_beside = 1e-6;
      EXPECT_TRUE(is_there(0.5 * (begin + end)));
      if (begin > 0.0 && begin - last > 2 * k_beside) {
        EXPECT_FALSE(is_there(begin - k_beside));
      }
      last = end;
      edges += (begin > 0.0) + (end < 1.0);
    }
    for (int i = 0; i < 200; ++i) {
      const double s = random.uniform(0.0, 1.0);
      const bool within = std::any_of(parts.begin(), parts.end(),
                                      [&](const auto& part) { return part.from <= s && s <= part.to; });
      EXPECT_EQ(is_there(s), within) << "at " << s << " of segment " << segment;
    }
  }
  EXPECT_GT(edges, 500u);
}

INSTANTIATE_TEST_SUITE_P(ItsSides, CutOutsBeyond,
                         testing::Values(TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror));

TEST(CutOuts, AreBlendedBetweenTheMiddlesOfTexels) {
  // Two texels, of alpha 0 and 1: 0.25 is a quarter of the way from one's middle to the other's.
  scene::Geometry geometry;
  tests::add_triangle(geometry, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  geometry.textures = {{{2, 1}, {{0, 0, 0, 0}, {0, 0, 0, 255}}}};
  geometry.texture_places = {{{{0, 0}, {1, 0}, {0, 1}}}};
  geometry.materials[0] = {.wrap = {TextureWrap::clamp, TextureWrap::clamp},
                           .cut_out = scene::CutOut{0, 0.25f}};
  std::vector<CutOuts::Part> parts;
  CutOuts(geometry).find_parts(0, {1, 0, 0}, {0, 1, 0}, parts);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(parts[0].from, 0.25 + 0.25 * 0.5, 1e-12);
  EXPECT_EQ(parts[0].to, 1.0);
}

TEST(CutOuts, RefuseATextureThatIsRepeatedBeyondSinglePrecision) {
  scene::Geometry geometry = airlight::tests::half_cut_away();
  geometry.texture_places[1][2].x = 1e9f;
  try {
    const CutOuts cut_outs(geometry);
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::bad_file);
    EXPECT_THAT(error.what(), testing::HasSubstr("the model's cut-outs"));
  }
}

/// What is left of a wall is as a wall of that size, by every way to ask.
class WallCutInHalf : public testing::TestWithParam<bool> {
 protected:
  scene::View view() const {
    scene::View view = airlight::tests::view_of_half_wall({24, 16});
    if (GetParam()) view.lights[0] = scene::sun("", {0.2, 0.3, -1}, glm::vec3(10));
    return view;
  }
};

TEST_P(WallCutInHalf, CastsItsShadowOnFogAndSurfaces) {
  const Reference cut(airlight::tests::half_cut_away(), view()), small(airlight::tests::half_wall(), view());
  const AirlightImage truth = small.exact();
  // The edges are found in double precision, from places rounded to single.
  EXPECT_LT(tests::rrmse(cut.exact(), truth), 1e-6);
  EXPECT_LT(tests::rrmse(cut.sampled(256), small.sampled(256)), 1e-5);
  for (const RayMode mode : {RayMode::single, RayMode::packet})
    EXPECT_EQ(cut.march(64, mode).radiance, small.march(64, mode).radiance);
  const SurfaceImage of_cut = cut.surfaces(), of_small = small.surfaces();
  EXPECT_EQ(of_cut.visibility, of_small.visibility);
  EXPECT_EQ(of_cut.distance, of_small.distance);
  EXPECT_GT(tests::rrmse(Reference(airlight::tests::whole_wall(), view()).exact(), truth), 0.05);
}

TEST_P(WallCutInHalf, IsJudgedSo) {
  const auto judged = [&](const scene::Geometry& geometry, glm::vec3 at) {
    const Triangles triangles(geometry);
    const glm::dvec3 origin = GetParam() ? view().camera.eye : view().lights[0].position;
    const auto floor = static_cast<std::uint32_t>(geometry.triangles.size() - 1);
    return SurfaceJudge(triangles, view().lights[0], view().camera.eye)
        .judge({glm::vec3(glm::dvec3(at) - origin), floor});
  };
  std::size_t dark = 0, decided = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 at(-4.0f + 0.02f * static_cast<float>(i), -1.0f, -3.3f);
    const SurfaceVerdict cut = judged(airlight::tests::half_cut_away(), at),
                         small = judged(airlight::tests::half_wall(), at);
    if (!cut.is_decided || !small.is_decided) continue;
    EXPECT_EQ(cut.verdict, small.verdict) << "at " << at.x;
    dark += small.verdict == Verdict::dark;
    ++decided;
  }
  EXPECT_GT(decided, 395u);
  EXPECT_TRUE(dark > 20u && dark < 380u) << dark;
}

INSTANTIATE_TEST_SUITE_P(ByALampAndASun, WallCutInHalf, testing::Bool());

}  // namespace
}  // namespace airlight::reference
