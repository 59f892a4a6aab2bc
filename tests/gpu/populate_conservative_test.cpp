#include <algorithm>
#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "epipolar/volume.h"
#include "scene/import.h"
#include "support/frame_probe.h"
#include "support/grid_bits.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/truth.h"

/// PopulateConservative: unit/epipolar/conservative_test.cpp proves what a triangle notes; here all of them
/// are on the GPU.
namespace airlight::epipolar {
namespace {

constexpr Resolution k_resolution{128, 512, 256};
constexpr float k_growth = 1.5f;

/// The scanned grid of a view, and points of its scene to look up.
class Grids {
 public:
  Grids(const scene::Geometry& geometry, const scene::View& view) : geometry_(geometry), view_(view) {
    tests::look_into_frame(geometry, view, 1024, [&](const frame::FrameInputs& inputs) {
      bits_ = bits_of(inputs, Populate::conservative);
      from_shadow_map_ = bits_of(inputs, Populate::shadow_map);
    });
  }

  /// Fraction of the grid that is dark.
  double dark() const { return fraction(bits_); }
  double dark_from_shadow_map() const { return fraction(from_shadow_map_); }

  /// Of points on the triangles and inside the grid, in double precision: how many there are, and how many of
  /// those lie in a voxel that is not set.
  std::pair<int, int> missed(int points) const {
    tests::Random random(7);
    const Resolution& n = k_resolution;
    const scene::Light& light = view_.lights[0];
    const glm::dvec3 eye = view_.camera.eye;
    const Axes axes = make_axes(scene::direction_to(light, eye));
    int inside = 0, missed = 0;
    for (int sample = 0; sample < points; ++sample) {
      const glm::uvec3 triangle = geometry_.triangles[random.bits() % geometry_.triangles.size()];
      const double a = std::sqrt(random.uniform()), b = a * random.uniform();
      const glm::dvec3 p = (1 - a) * glm::dvec3(geometry_.positions[triangle.x]) +
                           (a - b) * glm::dvec3(geometry_.positions[triangle.y]) +
                           b * glm::dvec3(geometry_.positions[triangle.z]) - eye;
      const double x = glm::dot(p, axes.u), y = glm::dot(p, axes.f), z = glm::dot(p, axes.axis);
      const double across = std::hypot(x, y);
      const double i = tests::cells_of_alpha(space_, std::atan2(across, z));
      const double j = tests::cells_of_theta(space_, std::atan2(y, x));
      if (i >= n.alpha || j < 0 || j >= n.theta) continue;
      const double phi =
          scene::is_sun(light) ? across : std::atan2(across, glm::distance(light.position, eye) - z);
      const double k = tests::cells_of_phi(cells_[static_cast<std::size_t>(j)], phi);
      if (k < 0 || k >= n.phi) continue;
      ++inside;
      missed += !tests::is_set(bits_, n, static_cast<int>(std::max(i, 0.0)), static_cast<int>(j),
                               static_cast<int>(k));
    }
    return {inside, missed};
  }

 private:
  std::vector<std::uint32_t> bits_of(const frame::FrameInputs& inputs, Populate populate) {
    ShadowVolume volume(inputs.context.limits(), {.resolution = k_resolution, .populate = populate});
    tests::build(volume, inputs, k_growth);
    space_ = volume.grid().block().read<shaders::EpipolarBlock>().at(0);
    cells_ = tests::phi_cells(volume);
    return volume.grid().bits().read<std::uint32_t>();
  }

  static double fraction(const std::vector<std::uint32_t>& bits) {
    return static_cast<double>(tests::count_set(bits)) / (32.0 * static_cast<double>(bits.size()));
  }

  const scene::Geometry& geometry_;
  scene::View view_;
  std::vector<std::uint32_t> bits_, from_shadow_map_;
  shaders::EpipolarBlock space_{};
  std::vector<shaders::PhiCells> cells_;
};

void expect_conservative(const scene::Geometry& geometry, const scene::View& view) {
  const Grids grids(geometry, view);
  const auto [inside, missed] = grids.missed(300000);
  EXPECT_GT(inside, 10000);
  EXPECT_EQ(missed, 0) << "of " << inside;
  testing::Test::RecordProperty("dark", std::to_string(grids.dark()));
  testing::Test::RecordProperty("dark_from_shadow_map", std::to_string(grids.dark_from_shadow_map()));
  EXPECT_GT(grids.dark(), grids.dark_from_shadow_map());
}

class ConservativeBuiltin : public testing::TestWithParam<const char*> {};

TEST_P(ConservativeBuiltin, EveryPointIsInASetVoxel) {
  const scene::Scene& scene = tests::builtin(GetParam());
  expect_conservative(scene.geometry, tests::view_of(scene, {64, 64}));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ConservativeBuiltin,
                         testing::Values("cornell", "window", "sphere", "half-space", "nave"));

class ConservativeShared : public testing::TestWithParam<tests::CyclesImage> {};

TEST_P(ConservativeShared, EveryPointIsInASetVoxel) {
  const tests::CyclesImage& truth = GetParam();
  AIRLIGHT_NEEDS(truth.scene_file());
  const scene::Scene scene = scene::import_scene(truth.scene_file());
  scene::View view = truth.view();
  view.size = {64, 64};
  expect_conservative(scene.geometry, view);
}

INSTANTIATE_TEST_SUITE_P(Models, ConservativeShared,
                         testing::Values(tests::k_cycles_airlight[1], tests::k_cycles_airlight[2],
                                         tests::k_cycles_airlight[3], tests::k_cycles_sun_airlight[0],
                                         tests::k_cycles_sun_airlight[1]));

TEST(ConservativeSphere, IsDarkerThanItsShadowByNoMoreThanACell) {
  // A sphere's shadow grows by what conservative cells add at its outline: about one cell in each angle.
  const scene::Scene& scene = tests::builtin("sphere");
  const Grids grids(scene.geometry, tests::view_of(scene, {64, 64}));
  EXPECT_LT(grids.dark() / grids.dark_from_shadow_map(), 1.12);
}

}  // namespace
}  // namespace airlight::epipolar
