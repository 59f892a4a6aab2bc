#include <string_view>

#include <gtest/gtest.h>

#include "reference/reference.h"
#include "scene/import.h"
#include "scene/transmission.h"
#include "support/scenes.h"
#include "support/truth.h"
#include "unit/reference/fixtures.h"

/// Rays against the truth without sampling: two ways to the same image, which meet as samples grow.
namespace airlight::reference {
namespace {

using tests::rrmse;

/// What Embree's single precision leaves between the images however many rays there are: it widens triangles
/// by 1e-7 of their size, which is 4e-5 of the light on `half-space`, whose triangles are large; and moves
/// the edge of a shadow by 1e-7/sin α along a view ray, 1e-4 of the light beside thin bars near the epipole.
constexpr double k_single_precision = 2e-4;

void expect_convergence(std::string_view name, const scene::Geometry& geometry, const scene::View& view) {
  const Reference reference(geometry, view);
  const AirlightImage truth = reference.exact();
  constexpr int k_coarse = 256, k_fine = 4096;
  const double march_coarse = rrmse(reference.march(k_coarse, RayMode::packet), truth);
  const double march_fine = rrmse(reference.march(k_fine, RayMode::packet), truth);
  EXPECT_LE(march_fine, 4.0 / 16.0 * march_coarse + k_single_precision)
      << name << ": an edge is off by a step";
  // Within a narrow cone lie few of the steps, and its edges are off by up to one.
  if (!view.lights[0].cone) {
    EXPECT_LE(march_fine, 5e-3) << name;
  }
  const double sampled_coarse = rrmse(reference.sampled(k_coarse), truth);
  const double sampled_fine = rrmse(reference.sampled(k_fine), truth);
  EXPECT_LE(sampled_fine, 4.0 / 16.0 * sampled_coarse + k_single_precision) << name;
  EXPECT_LE(sampled_fine, march_fine + k_single_precision) << name << ": edges are bisected";
}

TEST(Convergence, OnBuiltinScenes) {
  for (const scene::BuiltinScene& builtin : scene::builtin_scenes()) {
    const scene::Scene& scene = airlight::tests::builtin(builtin.name);
    if (scene::transmits(scene.geometry)) continue;  // rays do not show that
    expect_convergence(builtin.name, scene.geometry, airlight::tests::view_of(scene, {24, 24}));
  }
}

TEST(Convergence, OnModels) {
  for (const airlight::tests::CyclesImage& cycles : airlight::tests::k_cycles_airlight) {
    AIRLIGHT_NEEDS(cycles.scene_file());
    scene::View view = cycles.view();
    view.size = {24, 24};
    expect_convergence(cycles.scene, scene::import_scene(cycles.scene_file()).geometry, view);
  }
}

}  // namespace
}  // namespace airlight::reference
