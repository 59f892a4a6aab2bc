#include "epipolar/populate_screen_space.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "epipolar/volume.h"
#include "scene/import.h"
#include "support/frame_probe.h"
#include "support/grid_bits.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared.h"

namespace airlight::epipolar {
namespace {

constexpr Resolution k_resolution{96, 300, 256};
constexpr float k_growth = 1.0f;

scene::View make_view(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 light) {
  scene::View view;
  view.camera.eye = eye;
  view.camera.target = target;
  view.lights[0].position = light;
  view.size = {48, 48};
  return view;
}

/// The bits before the scan and after it, and after that of the conservative voxelization.
struct Bits {
  std::vector<std::uint32_t> solid, shadow, conservative;
  shaders::EpipolarBlock space;
  std::vector<shaders::PhiCells> cells;  ///< of each half-plane
};

Bits bits_of(const scene::Geometry& geometry, const scene::View& view) {
  Bits bits;
  tests::look_into_frame(geometry, view, 64, [&](const frame::FrameInputs& inputs) {
    ShadowVolume solid(inputs.context.limits(),
                       {.resolution = k_resolution, .populate = Populate::screen_space});
    bits.space = solid.find_ranges(inputs);
    tests::set_growth(solid, k_growth);
    solid.fill_unscanned(inputs);
    bits.cells = tests::phi_cells(solid);
    bits.solid = solid.grid().bits().read<std::uint32_t>();
    solid.fill(inputs);
    bits.shadow = solid.grid().bits().read<std::uint32_t>();
    ShadowVolume conservative(inputs.context.limits(),
                              {.resolution = k_resolution, .populate = Populate::conservative});
    conservative.find_ranges(inputs);
    tests::set_growth(conservative, k_growth);
    // On the same cells of α, which start at the axis for the solid.
    conservative.grid().block().write(&bits.space, sizeof bits.space);
    conservative.fill(inputs);
    bits.conservative = conservative.grid().bits().read<std::uint32_t>();
  });
  return bits;
}

bool bit(const std::vector<std::uint32_t>& words, int i, int j, int k) {
  return tests::is_set(words, k_resolution, i, j, k);
}

/// The centre of a voxel; infinitely far where its view and light ray do not meet.
glm::dvec3 centre(const Bits& bits, const scene::View& view, int i, int j, int k) {
  const glm::dvec3 to_light = view.lights[0].position - view.camera.eye;
  const double D = glm::length(to_light);
  const Axes axes = make_axes(to_light / D);
  const double alpha = tests::alpha_of_cells(bits.space, i + 0.5);
  const auto theta = static_cast<double>(shaders::theta_centre(bits.space, static_cast<std::uint32_t>(j)));
  const auto phi = static_cast<double>(shaders::phi_of_cell(bits.cells[static_cast<std::size_t>(j)],
                                                            shaders::Cell(static_cast<float>(k) + 0.5f)));
  const double t = alpha + phi < std::numbers::pi - 1e-6 ? D * std::sin(phi) / std::sin(alpha + phi) : 1e9;
  return view.camera.eye + t * (std::sin(alpha) * (std::cos(theta) * axes.u + std::sin(theta) * axes.f) +
                                std::cos(alpha) * axes.axis);
}

/// Compares voxels with a solid in closed form. `depth`: how far a point lies inside it [m], < 0 outside.
void expect_solid(const scene::Geometry& geometry, const scene::View& view,
                  const std::function<double(glm::dvec3)>& depth, double tolerance) {
  const Bits bits = bits_of(geometry, view);
  tests::Random random(1);
  int inside = 0, wrong = 0;
  for (int sample = 0; sample < 400000; ++sample) {
    const int i = static_cast<int>(random.uniform(0, k_resolution.alpha));
    const int j = static_cast<int>(random.uniform(0, k_resolution.theta));
    const int k = static_cast<int>(random.uniform(0, k_resolution.phi));
    const glm::dvec3 point = centre(bits, view, i, j, k);
    const double in = depth(point);
    if (std::abs(in) < tolerance * std::max(1.0, glm::length(point - view.camera.eye))) continue;
    inside += in > 0 ? 1 : 0;
    wrong += bit(bits.solid, i, j, k) != (in > 0) ? 1 : 0;
  }
  EXPECT_GT(inside, 500);
  EXPECT_EQ(wrong, 0) << inside << " inside";
}

double in_box(glm::dvec3 p, glm::dvec3 lower, glm::dvec3 upper) {
  const glm::dvec3 d = glm::min(p - lower, upper - p);
  return std::min({d.x, d.y, d.z});
}

constexpr double k_single = 1e-4;  // of the distance: what single precision makes of φ, over its cells' width

TEST(ScreenSpace, BoxesThatOverlapAreTheirUnion) {
  scene::Geometry geometry;
  tests::add_box(geometry, {-1, -1, -1}, {0.5, 0.5, 0.5});
  tests::add_box(geometry, {-0.5, -0.5, -0.5}, {1, 1, 1});
  tests::add_box(geometry, {-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2});  // inside both
  for (const glm::dvec3 light : {glm::dvec3(2, 2, -3), glm::dvec3(0.3, 0.2, -4), glm::dvec3(-3, 1, 4)}) {
    expect_solid(
        geometry, make_view({0.2, 0.3, 4}, {0, 0, 0}, light),
        [](glm::dvec3 p) {
          return std::max(in_box(p, {-1, -1, -1}, {0.5, 0.5, 0.5}), in_box(p, {-0.5, -0.5, -0.5}, {1, 1, 1}));
        },
        k_single);
  }
}

TEST(ScreenSpace, BoxAboutTheEyeIsSolid) {
  scene::Geometry geometry;
  tests::add_box(geometry, {-1, -1, -1}, {1, 1, 1});
  scene::View view = make_view({0.2, 0.3, 0.1}, {0, 0, -1}, {0.5, 0.2, -4});
  expect_solid(
      geometry, view,
      [](glm::dvec3 p) {
        return in_box(p, {-1, -1, -1}, {1, 1, 1});
      },
      k_single);
}

TEST(ScreenSpace, SphereIsSolid) {
  const scene::Scene& scene = tests::builtin("sphere");
  // Its 20,480 triangles lie up to 3e-4 m inside the sphere.
  expect_solid(
      scene.geometry, tests::view_of(scene, {48, 48}), [](glm::dvec3 p) { return 1 - glm::length(p); }, 1e-3);
}

TEST(ScreenSpace, OccluderNearerTheAxisThanTheImageShadows) {
  // The image begins beyond the box, which stands between eye and light.
  scene::Geometry geometry;
  tests::add_box(geometry, {-0.1, -0.1, -2.2}, {0.1, 0.1, -2});
  const scene::View view = make_view({0, 0, 0}, {3, 0, -2}, {0, 0, -4});
  const double least_alpha =
      alpha_range(scene::camera_frame(view.camera, view.size), glm::dvec3(0, 0, -1)).lower;
  const double largest_alpha = std::atan(std::hypot(0.1, 0.1) / 2);
  ASSERT_GT(least_alpha, 2 * largest_alpha);
  const Bits bits = bits_of(geometry, view);
  int met = 0, passed = 0, doubtful = 0, wrong = 0;
  for (int j = 0; j < k_resolution.theta; ++j) {
    for (int k = 0; k < k_resolution.phi; ++k) {
      // Along a light ray, the cells whose centre lies in the box, and all behind the first of them.
      bool is_in_shadow = false, is_doubtful = false;
      int differing = 0;
      for (int i = 0; i < k_resolution.alpha; ++i) {
        const double alpha = tests::alpha_of_cells(bits.space, i + 0.5);
        const double depth = alpha < 2 * largest_alpha
                                 ? in_box(centre(bits, view, i, j, k), {-0.1, -0.1, -2.2}, {0.1, 0.1, -2})
                                 : -1;
        is_doubtful = is_doubtful || std::abs(depth) < k_single;
        is_in_shadow = is_in_shadow || depth > 0;
        differing += bit(bits.solid, i, j, k) != (depth > 0);
        differing += bit(bits.shadow, i, j, k) != is_in_shadow;
      }
      if (is_doubtful) {
        ++doubtful;
      } else {
        ++(is_in_shadow ? met : passed);
        wrong += differing > 0;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(met, 4 * k_resolution.theta);
  EXPECT_GT(passed, k_resolution.phi * k_resolution.theta / 2);
  EXPECT_LT(doubtful, met / 50);
}

class ScreenSpaceModel : public testing::TestWithParam<const char*> {};

TEST_P(ScreenSpaceModel, InsideIsInTheShadowOfItsOwnTriangles) {
  const auto file = tests::shared_file(std::string("scenes/") + GetParam() + ".glb");
  AIRLIGHT_NEEDS(file);
  const scene::Scene scene = scene::import_scene(file);
  const scene::Camera camera = scene::fit_camera(scene.geometry);
  const scene::View view =
      make_view(camera.eye, camera.target, 2.0 * camera.target - camera.eye + glm::dvec3(0.3));
  const Bits bits = bits_of(scene.geometry, view);
  // A crossing that is missed or found twice would flip a whole row.
  std::size_t lit = 0;
  for (std::size_t word = 0; word < bits.solid.size(); ++word) {
    lit += static_cast<std::size_t>(std::popcount(bits.solid[word] & ~bits.conservative[word]));
  }
  const std::size_t set = tests::count_set(bits.solid);
  EXPECT_GT(set, 10000u);
  EXPECT_EQ(lit, 0u) << "of " << set;
}

INSTANTIATE_TEST_SUITE_P(Watertight, ScreenSpaceModel, testing::Values("bunny_closed_144k", "lucy_100k"));

TEST(DealApart, BoxesOfAGroupDoNotTouch) {
  tests::Random random(2);
  std::vector<scene::Box> boxes(500);
  for (scene::Box& box : boxes) {
    const glm::dvec3 lower = random.in_box(5.0), size = random.in_box(0.5);
    box.include(glm::vec3(lower));
    box.include(glm::vec3(lower + size));
  }
  const std::vector<std::uint32_t> group = deal_apart(boxes);
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (group[a] != group[b]) continue;
      const bool apart = glm::any(glm::greaterThan(boxes[a].lower, boxes[b].upper)) ||
                         glm::any(glm::greaterThan(boxes[b].lower, boxes[a].upper));
      EXPECT_TRUE(apart) << a << " " << b;
    }
  }
  EXPECT_LT(*std::max_element(group.begin(), group.end()), 12u);
}

TEST(DealApart, BoxesApartAreOneGroup) {
  std::vector<scene::Box> boxes(10);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto at = static_cast<float>(2 * i);
    boxes[i].include(glm::vec3(at));
    boxes[i].include(glm::vec3(at + 1.0f));
  }
  for (const std::uint32_t group : deal_apart(boxes)) EXPECT_EQ(group, 0u);
}

}  // namespace
}  // namespace airlight::epipolar
