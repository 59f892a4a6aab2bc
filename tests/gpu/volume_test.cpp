#include "epipolar/volume.h"

#include <cmath>

#include <gtest/gtest.h>

#include "media/vsv.h"
#include "support/frame_probe.h"
#include "support/grid_bits.h"
#include "support/random.h"
#include "support/scenes.h"

/// Half-planes with ranges of φ of their own, against those that share one.
namespace airlight::epipolar {
namespace {

using tests::builtin;
using tests::view_of;

constexpr Resolution k_resolution{128, 200, 512};

/// A grid on the CPU.
struct GridOf {
  shaders::EpipolarBlock space;
  std::vector<shaders::PhiCells> cells;
  std::vector<std::uint32_t> bits;
  std::vector<float> range;

  /// Whether a view ray is in shadow at φ; outside of a plane's cells all is lit.
  bool is_dark(int i, int j, double phi) const {
    const double k = tests::cells_of_phi(cells[static_cast<std::size_t>(j)], phi);
    return k >= 0 && k < k_resolution.phi && tests::is_set(bits, k_resolution, i, j, static_cast<int>(k));
  }

  /// The largest φ where a view ray of the frame ends in a plane.
  double seen(int j) const {
    const shaders::Order order(range[2 + static_cast<std::size_t>(j)]);
    return static_cast<double>(shaders::phi_from_order(space, order));
  }
};

GridOf grid_of(const frame::FrameInputs& inputs, Populate populate, bool own_ranges) {
  ShadowVolume volume(inputs.context.limits(), {.resolution = k_resolution, .populate = populate});
  GridOf grid;
  grid.space = volume.find_ranges(inputs, own_ranges);
  tests::set_growth(volume, 1.5f);
  volume.fill(inputs);
  grid.cells = tests::phi_cells(volume);
  grid.bits = volume.grid().bits().read<std::uint32_t>();
  grid.range = volume.grid().phi_range().read<float>();
  return grid;
}

void expect_same_shadow(const scene::Geometry& geometry, const scene::View& view, Populate populate) {
  tests::look_into_frame(geometry, view, 1024, [&](const frame::FrameInputs& inputs) {
    const GridOf own = grid_of(inputs, populate, true), shared = grid_of(inputs, populate, false);
    ASSERT_EQ(own.space.own_ranges, 1.0f);
    ASSERT_EQ(shared.space.own_ranges, 0.0f);
    tests::Random random(1);
    int dark = 0, outside = 0, wrong_outside = 0, differing = 0, far_from_borders = 0;
    constexpr int k_samples = 200000;
    for (int sample = 0; sample < k_samples; ++sample) {
      const int i = static_cast<int>(random.uniform(0, k_resolution.alpha));
      const int j = static_cast<int>(random.uniform(0, k_resolution.theta));
      const shaders::PhiCells &cells = own.cells[static_cast<std::size_t>(j)],
                              &shared_cells = shared.cells[static_cast<std::size_t>(j)];
      const double phi = std::min(own.seen(j), static_cast<double>(shared_cells.phi_max)) * random.uniform();
      const bool expected = shared.is_dark(i, j, phi);
      dark += expected;
      // Of the shared cells, which are the wider ones, where they are widest.
      const double width = 1.8 * static_cast<double>(shared_cells.phi_max) / k_resolution.phi;
      if (tests::cells_of_phi(cells, phi + width) < 0.0 ||
          tests::cells_of_phi(cells, std::max(phi - width, 0.0)) > k_resolution.phi) {
        ++outside;
        wrong_outside += expected;
      } else if (own.is_dark(i, j, phi) != expected) {
        ++differing;
        // Each rounds a border to its own cells: within a cell of either there is one.
        bool is_near_border = false;
        for (const double step : {-2.0, -1.0, 1.0, 2.0}) {
          is_near_border = is_near_border || shared.is_dark(i, j, phi + step * width) != expected ||
                           own.is_dark(i, j, phi + step * width) == expected;
        }
        far_from_borders += !is_near_border;
      }
    }
    testing::Test::RecordProperty("outside", outside);
    testing::Test::RecordProperty("differing", differing);
    EXPECT_GT(dark, k_samples / 100);
    EXPECT_EQ(wrong_outside, 0) << "of " << outside << ": a shadow where nothing is said to cast one";
    EXPECT_LT(differing, dark / 5);
    EXPECT_EQ(far_from_borders, 0) << "of " << differing;
  });
}

class OwnRangesOf : public testing::TestWithParam<const char*> {};

TEST_P(OwnRangesOf, TheShadowMapLeaveNoShadowOut) {
  const scene::Scene& scene = builtin(GetParam());
  expect_same_shadow(scene.geometry, view_of(scene, {96, 80}), Populate::shadow_map);
}

TEST_P(OwnRangesOf, TrianglesLeaveNoShadowOut) {
  const scene::Scene& scene = builtin(GetParam());
  expect_same_shadow(scene.geometry, view_of(scene, {96, 80}), Populate::conservative);
}

TEST_P(OwnRangesOf, ASunLeaveNoShadowOut) {
  const scene::Scene& scene = builtin(GetParam());
  scene::View view = view_of(scene, {96, 80});
  for (const glm::dvec3& towards : {glm::dvec3(0.3, 1.0, -0.5), glm::dvec3(-1.0, 0.2, 0.3)}) {
    view.lights[0] = scene::sun("", towards, glm::vec3(1.0f));
    expect_same_shadow(scene.geometry, view, Populate::shadow_map);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnRangesOf, testing::Values("cornell", "window", "sphere"));

std::vector<glm::vec3> airlight_of(const scene::Geometry& geometry, const scene::View& view, Ranges ranges,
                                   media::VsvIntegral integral = media::VsvIntegral::table) {
  frame::Frame frame(tests::gpu_context(), geometry, 512);
  media::Vsv vsv(tests::gpu_context(),
                 {.integral = integral, .volume = {.resolution = k_resolution, .ranges = ranges}});
  frame::NoShadow no_shadow;
  gpu::StageTimer timer(nullptr);
  frame.render(view, no_shadow, vsv, timer);
  return frame.read().airlight;
}

/// The largest difference of two images, of the largest value.
double largest_difference(const std::vector<glm::vec3>& image, const std::vector<glm::vec3>& expected) {
  double difference = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const auto a = static_cast<double>(image[i][channel]), b = static_cast<double>(expected[i][channel]);
      difference = std::max(difference, std::abs(a - b));
      largest = std::max(largest, b);
    }
  }
  return difference / largest;
}

TEST(OwnRanges, OfAnEmptySceneGiveTheSameAirlight) {
  const scene::Scene& scene = builtin("empty");
  const scene::View view = view_of(scene, {48, 40});
  for (const media::VsvIntegral integral : {media::VsvIntegral::table, media::VsvIntegral::quadrature,
                                            media::VsvIntegral::riemann, media::VsvIntegral::factored}) {
    // The end of the range of α is rounded otherwise where rows are equal in √α, and with it the table's.
    EXPECT_LT(largest_difference(airlight_of(scene.geometry, view, Ranges::frame, integral),
                                 airlight_of(scene.geometry, view, Ranges::alpha_phi, integral)),
              3e-7)
        << static_cast<int>(integral);
  }
}

TEST(OwnRanges, OfALitWallGiveTheSameAirlight) {
  // The wall behind all that is seen casts no shadow on it: no bit decides.
  scene::Geometry wall;
  tests::add_quad(wall, {-30, -30, -4}, {60, 0, 0}, {0, 60, 0});
  scene::View view;
  view.camera.eye = {0, 0, 3};
  view.camera.target = {0, 0, 0};
  view.size = {48, 40};
  for (const glm::dvec3& light : {glm::dvec3(0.5, 0.3, -2), glm::dvec3(5, 1, 3), glm::dvec3(0.2, 0.1, 9)}) {
    view.lights[0].position = light;
    EXPECT_LT(largest_difference(airlight_of(wall, view, Ranges::frame),
                                 airlight_of(wall, view, Ranges::alpha_phi)),
              1e-3)
        << light.z;  // what is interpolated between the table's columns
  }
  view.lights[0] = scene::sun("", {0.3, 1.0, 0.5}, glm::vec3(1.0f));
  // A sun's runs are in closed form.
  EXPECT_LT(
      largest_difference(airlight_of(wall, view, Ranges::frame), airlight_of(wall, view, Ranges::alpha_phi)),
      1e-5);
}

}  // namespace
}  // namespace airlight::epipolar
