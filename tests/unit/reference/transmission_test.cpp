#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reference/surface_judge.h"
#include "scene/transmission.h"
#include "support/panes.h"
#include "unit/reference/fixtures.h"

/// Light that passes triangles, in the truth of airlight and of surfaces.
namespace airlight::reference {
namespace {

using airlight::tests::of_glass, airlight::tests::panes_over_floor, airlight::tests::view_below_panes;

constexpr glm::vec3 k_glass(0.5f, 0.25f, 0.0f);

class Panes : public testing::TestWithParam<bool> {
 protected:
  scene::View view() const { return view_below_panes({24, 16}, GetParam()); }
  std::vector<glm::vec3> exact(const scene::Geometry& geometry) const {
    return Reference(geometry, view()).exact().radiance;
  }
};

TEST_P(Panes, LetTheirShareOfTheAirlightThrough) {
  const auto none = exact(panes_over_floor(0)), opaque = exact(panes_over_floor(1));
  const auto one = exact(of_glass(panes_over_floor(1), k_glass));
  std::size_t shadowed = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    shadowed += none[i].r > 1.05f * opaque[i].r;
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(one[i][channel], glm::mix(opaque[i], none[i], k_glass)[channel], 1e-5f * none[i][channel])
          << i;
  }
  EXPECT_GT(shadowed, one.size() / 5);
}

TEST_P(Panes, OfTwoTheSharesMultiplyWhereBothAreInTheWay) {
  // The farther pane's shadow lies about the nearer one's, or the other way round: with shares s of the one
  // and t of the other alone, and both behind one another, images are linear in each share.
  const auto image = [&](glm::vec3 lower, glm::vec3 upper) {
    scene::Geometry geometry = of_glass(panes_over_floor(2), lower);
    geometry.materials.push_back({.transmittance = upper});
    geometry.material_of_triangle[2] = geometry.material_of_triangle[3] =
        static_cast<std::uint32_t>(geometry.materials.size() - 1);
    return exact(geometry);
  };
  const glm::vec3 all(1.0f), nothing(0.0f), lower(0.5f, 0.25f, 0.8f), upper(0.6f, 0.3f, 0.9f);
  const auto both = image(lower, upper), clear = image(all, all), lower_dark = image(nothing, all),
             upper_dark = image(all, nothing), dark = image(nothing, nothing);
  for (std::size_t i = 0; i < both.size(); ++i) {
    const glm::vec3 expected = (1.0f - lower) * (1.0f - upper) * dark[i] +
                               lower * (1.0f - upper) * upper_dark[i] +
                               (1.0f - lower) * upper * lower_dark[i] + lower * upper * clear[i];
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(both[i][channel], expected[channel], 2e-5f * clear[i][channel]) << i;
  }
}

TEST_P(Panes, AreOpaqueWhereThatIsAsked) {
  scene::Geometry glass = of_glass(panes_over_floor(1), k_glass);
  glass.transmission = scene::Transmission::opaque;
  EXPECT_EQ(exact(glass), exact(panes_over_floor(1)));
}

TEST_P(Panes, AreJudgedByTheirShares) {
  const scene::Geometry geometry = of_glass(panes_over_floor(2), k_glass);
  const Triangles triangles(geometry);
  const glm::dvec3 origin = GetParam() ? view().camera.eye : view().lights[0].position;
  const SurfaceJudge judge(triangles, view().lights[0], view().camera.eye);
  const auto at = [&](glm::vec3 point) {
    return judge.judge(
        {glm::vec3(glm::dvec3(point) - origin), static_cast<std::uint32_t>(triangles.count() - 1)});
  };
  EXPECT_EQ(at({5, -1, -3}), (SurfaceVerdict{Verdict::lit, true}));
  const SurfaceVerdict behind_both = at({0.05f, -1, -2.9f});
  EXPECT_TRUE(behind_both.is_decided);
  EXPECT_EQ(behind_both.share, k_glass * k_glass);
}

TEST_P(Panes, OfTriangleThatShareAnEdgeCountOnce) {
  // Under the pane's diagonal, exactly.
  const scene::View seen = view();
  scene::Geometry geometry;
  airlight::tests::add_quad(geometry, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  airlight::tests::add_quad(geometry, {-8, -1, 8}, {16, 0, 0}, {0, 0, -16});
  geometry = of_glass(geometry, glm::vec3(0.5f));
  const Triangles triangles(geometry);
  const scene::Light light =
      GetParam() ? scene::sun("", {0, 1, 0}, glm::vec3(1)) : scene::point_light("", {0, 3, 0}, {});
  const glm::dvec3 eye(0, 0.5, 0), origin = GetParam() ? eye : light.position;
  const SurfaceJudge judge(triangles, light, eye);
  for (const float x : {-0.5f, -0.25f, 0.0f, 0.25f, 0.75f}) {
    const SurfaceVerdict verdict = judge.judge(
        {glm::vec3(glm::dvec3(x, -1, x) - origin), static_cast<std::uint32_t>(triangles.count() - 2)});
    EXPECT_EQ(verdict.share, glm::vec3(0.5f)) << x;
    EXPECT_TRUE(verdict.is_decided) << x;
  }
}

INSTANTIATE_TEST_SUITE_P(ByALampAndASun, Panes, testing::Bool());

TEST(Panes, GlowFromBehind) {
  scene::Geometry geometry = of_glass(panes_over_floor(2), glm::vec3(0.5f));
  const Triangles triangles(geometry);
  // The eye is below both panes, the lamp above.
  const glm::dvec3 eye(0, 0, -3), lamp(0.1, 3, -3.1);
  const SurfaceJudge judge(triangles, scene::point_light("", lamp, {}), eye);
  EXPECT_FALSE(judge.faces(0));
  EXPECT_EQ(judge.judge({glm::vec3(glm::dvec3(0.3, 1, -3.2) - lamp), 0}).share, glm::vec3(0.25f))
      << "what passes the upper one and itself";
  EXPECT_EQ(judge.judge({glm::vec3(glm::dvec3(0.3, 1.5, -3.2) - lamp), 2}).share, glm::vec3(0.5f));
}

}  // namespace
}  // namespace airlight::reference
