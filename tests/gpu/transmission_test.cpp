// What light passes, by every method that shows it.
#include "scene/transmission.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "frame/point_reader.h"
#include "quality/metrics.h"
#include "quality/traced.h"
#include "support/panes.h"
#include "support/shadow_cases.h"
#include "surface_shadows/metric_tree.h"
#include "surface_shadows/psv.h"

namespace airlight::surface_shadows {
namespace {

using tests::ShadowCase;

frame::FrameImages images(const ShadowCase& shown, frame::SurfaceShadow& method) {
  frame::Frame frame(tests::gpu_context(), shown.geometry, 16);
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(nullptr);
  frame.render(shown.view, method, no_airlight, timer);
  return frame.read();
}

std::vector<glm::vec3> shares(const ShadowCase& shown, frame::SurfaceShadow& method) {
  return images(shown, method).transmittance.at(0);
}

/// Of four triangles one is opaque; and x-ray views.
std::vector<ShadowCase> glass_cases() {
  std::vector<ShadowCase> cases;
  for (const char* name : {"layers", "soup above", "soup inside", "soup low sun"}) {
    const auto& all = tests::shadow_cases();
    ShadowCase given = *std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; });
    scene::Geometry& geometry = given.geometry;
    geometry.materials = {{},
                          {.transmittance = {0.9f, 0.5f, 0.0f}},
                          {.transmittance = {0.3f, 0.8f, 0.95f}},
                          {.transmittance = glm::vec3(0.7f)}};
    // The first two are the floor.
    for (std::size_t i = 2; i < geometry.triangles.size(); ++i)
      geometry.material_of_triangle[i] = static_cast<std::uint32_t>(i / 2 % 4);
    cases.push_back(given);
  }
  cases.push_back(cases[1]);
  cases.back().name += ", x-ray";
  cases.back().geometry.transmission = scene::Transmission::x_ray;
  cases.push_back(cases[3]);
  cases.back().name += ", coloured x-ray";
  cases.back().geometry.transmission = scene::Transmission::x_ray_coloured;
  return cases;
}

TEST(Transmission, IsTheSameBitForBitByEveryTree) {
  std::vector<std::pair<std::string, std::unique_ptr<frame::SurfaceShadow>>> methods;
  const auto psv = [&](const char* name, const PsvOptions& options) {
    methods.emplace_back(name, std::make_unique<Psv>(options));
  };
  const auto metric_tree = [&](const char* name, const MetricTreeOptions& options) {
    methods.emplace_back(name, std::make_unique<MetricTree>(options));
  };
  psv("psv", {});
  psv("psv, another seed", {.seed = 7});
  psv("psv, stackless", {.traversal = Traversal::stackless});
  psv("psv, a stack of one", {.stack = 1});
  psv("psv, culling", {.cull = Culling::automatic});
  metric_tree("metric-tree", {});
  metric_tree("metric-tree, single triangles", {.cluster = 1});
  metric_tree("metric-tree, a stack of one", {.stack = 1});
  metric_tree("metric-tree, culling", {.cull = Culling::automatic});
  for (const ShadowCase& shown : glass_cases()) {
    Brute brute({});
    const std::vector<glm::vec3> expected = shares(shown, brute);
    std::size_t coloured = 0;
    for (const glm::vec3& share : expected)
      coloured += share != glm::vec3(share.r) || (share.r > 0 && share.r < 1);
    EXPECT_GT(coloured, 50u) << shown.name;
    for (auto& [name, method] : methods)
      EXPECT_TRUE(shares(shown, *method) == expected) << shown.name << ", " << name;
  }
}

TEST(Transmission, IsRightWhereTheJudgeIsSure) {
  for (const ShadowCase& shown : glass_cases()) {
    frame::PointReader reader;
    images(shown, reader);
    Psv psv({});
    quality::SharedReference reference(shown.geometry, shown.view, {});
    const quality::SurfaceError error =
        quality::surface_error(shares(shown, psv), reference.verdicts(0, reader.points()));
    EXPECT_EQ(error.wrong_pixels, 0u) << shown.name;
    EXPECT_LT(error.undecided(), 0.02) << shown.name;
    EXPECT_GT(error.pixels, 500u) << shown.name;
  }
}

TEST(Transmission, ColoursSurfacesAndLetsGlassGlow) {
  // Seen from below: the floor beside, and the pane itself from its dark side.
  ShadowCase shown{"glow", tests::of_glass(tests::panes_over_floor(1), {0.8f, 0.4f, 0.0f}),
                   tests::view_below_panes({48, 48}, false)};
  shown.view.camera.target = {0, 1, -3};
  shown.view.medium.sigma_s = glm::vec3(0.1f);
  shown.view.camera.vertical_fov_degrees = 70;
  Psv psv({});
  const frame::FrameImages glass = images(shown, psv);
  std::size_t glowing = 0;
  for (std::size_t i = 0; i < glass.radiance.size(); ++i) {
    const glm::vec3 radiance = glass.radiance[i];
    if (radiance.r > 0 && radiance.b == 0) {
      EXPECT_NEAR(radiance.g, 0.5f * radiance.r, 1e-5f * radiance.r);  // its fog takes as much of each
      ++glowing;
    }
  }
  EXPECT_GT(glowing, 100u);
  shown.geometry.transmission = scene::Transmission::opaque;
  const frame::FrameImages opaque = images(shown, psv);
  EXPECT_TRUE(opaque.transmittance.empty());
  std::size_t darker = 0;
  for (std::size_t i = 0; i < glass.radiance.size(); ++i)
    darker += opaque.radiance[i].r < 0.9f * glass.radiance[i].r;
  EXPECT_GE(darker, glowing);
}

}  // namespace
}  // namespace airlight::surface_shadows
