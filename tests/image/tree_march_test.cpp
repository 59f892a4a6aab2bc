#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/panes.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/truth.h"
#include "unit/reference/fixtures.h"

/// Airlight by asking trees of triangles along view rays, against the reference.
namespace airlight {
namespace {

using media::MarchLookUp, media::MarchTree;

constexpr MarchTree k_trees[] = {MarchTree::psv, MarchTree::metric_tree};

TEST(TreeMarch, ComesToTheReferenceWithItsStepsAlone) {
  // No shadow map and no cells: what is left falls with the step.
  const scene::Scene& scene = tests::builtin("cornell");
  const scene::View view = tests::view_of(scene, {32, 32});
  const tests::Truth truth = tests::trace(scene.geometry, view);
  double before = 1e30, error = 0.0;
  for (const int steps : {16, 64, 256}) {
    error =
        tests::error_of(
            tests::render_march(scene.geometry, view, {.steps = steps, .look_up = MarchLookUp::tree}), truth)
            .rrmse;
    EXPECT_LT(error, 0.5 * before) << steps;
    before = error;
  }
  EXPECT_LT(error, 1e-3);
}

class TreeMarchBehindGlass : public testing::TestWithParam<bool> {};

TEST_P(TreeMarchBehindGlass, HasColouredShafts) {
  const scene::Geometry geometry = tests::of_glass(tests::panes_over_floor(2), {0.9f, 0.4f, 0.0f});
  const scene::View view = tests::view_below_panes({32, 24}, GetParam());
  const tests::Truth truth = tests::trace(geometry, view);
  for (const MarchTree tree : k_trees) {
    const frame::FrameImages image =
        tests::render_march(geometry, view, {.steps = 256, .look_up = MarchLookUp::tree, .tree = tree});
    EXPECT_LT(tests::error_of(image, truth).rrmse, 5e-3) << static_cast<int>(tree);
  }
  // What takes the panes for opaque is far off.
  EXPECT_GT(tests::error_of(tests::render_march(geometry, view, {.steps = 256}), truth).rrmse, 0.05);
}

INSTANTIATE_TEST_SUITE_P(ByALampAndASun, TreeMarchBehindGlass, testing::Bool());

TEST(TreeMarch, IsTheSameByBothTrees) {
  const scene::Scene& scene = tests::builtin("toroid");
  const scene::View view = tests::view_of(scene, {24, 24});
  const auto by = [&](MarchTree tree) {
    return tests::render_march(scene.geometry, view,
                               {.steps = 16, .look_up = MarchLookUp::tree, .tree = tree})
        .airlight;
  };
  EXPECT_TRUE(by(MarchTree::psv) == by(MarchTree::metric_tree));
}

}  // namespace
}  // namespace airlight
