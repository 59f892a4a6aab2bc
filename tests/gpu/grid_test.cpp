#include "epipolar/grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "epipolar/volume.h"
#include "reference/visibility.h"
#include "scene/error.h"
#include "support/frame_probe.h"
#include "support/grid_bits.h"
#include "support/random.h"
#include "support/scenes.h"

namespace airlight::epipolar {
namespace {

using reference::LightRays;
using reference::Visibility;
using tests::builtin;
using tests::view_of;

TEST(Grid, OverTheDriversLimitIsAnErrorThatNamesIt) {
  gpu::Context& context = tests::gpu_context();
  const std::int64_t limit = context.limits().max_texel_buffer_texels;
  // The smallest power of two of planes that is over the limit.
  int theta = 1;
  while (std::int64_t{4} * (1 << 17) * theta <= limit && theta < 1 << 17) theta *= 2;
  try {
    const Grid grid(context.limits(), {1 << 17, theta, 512});
    FAIL() << "the driver takes any grid";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), testing::HasSubstr("GL_MAX_TEXTURE_BUFFER_SIZE"));
    EXPECT_THAT(error.what(), testing::HasSubstr("--alpha"));
  }
  context.check();
}

TEST(Grid, LightRaysOverTheDriversLimitAreAnErrorThatNamesIt) {
  gpu::Context& context = tests::gpu_context();
  const std::int64_t limit = context.limits().max_storage_block_bytes;
  int theta = 1;
  while (std::int64_t{4} * (1 << 17) * theta <= limit && theta < 1 << 17) theta *= 2;
  try {
    const Grid grid(context.limits(), {1, theta, 1 << 17});
    FAIL() << "the driver takes any number of light rays";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), testing::HasSubstr("GL_MAX_SHADER_STORAGE_BLOCK_SIZE"));
  }
  context.check();
}

TEST(Grid, LargerThanOneStorageBufferIsFilledWindowByWindow) {
  gpu::Context& context = tests::gpu_context();
  const Resolution n{512, 5120, 512};
  const std::int64_t bytes = std::int64_t{512} * 5120 * 512 / 8;
  if (context.limits().max_storage_block_bytes >= bytes) {
    GTEST_SKIP() << "one storage buffer of this driver holds the grid";
  }
  const scene::Scene& scene = builtin("window");
  tests::look_into_frame(
      scene.geometry, view_of(scene, {32, 32}), 256, [&](const frame::FrameInputs& inputs) {
        const auto bits = [&](Scan scan) {
          ShadowVolume volume(inputs.context.limits(),
                              {.resolution = n, .scan = scan, .ranges = Ranges::alpha_phi});
          tests::build(volume, inputs, 1.0f);
          EXPECT_GT(volume.grid().windows().size(), 1u);
          EXPECT_EQ(volume.grid().bits().bytes(), bytes);
          return volume.bits();
        };
        const std::vector<std::uint32_t> fused = bits(Scan::fused);
        EXPECT_TRUE(fused == bits(Scan::blocks));
        EXPECT_TRUE(fused == bits(Scan::column));
        EXPECT_TRUE(fused == bits(Scan::multi_pass));
        // A plane at either side of the windows' border holds about as many bits as its neighbour.
        const std::size_t words = std::size_t{512} * 512 / 32;
        const auto set_in = [&](std::size_t plane) {
          return static_cast<double>(tests::count_set(std::span(fused).subspan(plane * words, words)));
        };
        for (std::size_t plane = 1; plane < 5120; ++plane)
          EXPECT_NEAR(set_in(plane), set_in(plane - 1), 0.05 * 32 * static_cast<double>(words)) << plane;
      });
}

/// How the grid is filled and scanned.
using Way = std::tuple<Populate, Scan>;

class GridWindows : public testing::TestWithParam<Way> {};

TEST_P(GridWindows, GiveTheBitsOfOne) {
  const auto& [populate, scan] = GetParam();
  const Resolution n{160, 37, 256};
  const std::int64_t plane_bytes = std::int64_t{160} * 256 / 8;
  const scene::Scene& scene = builtin("sphere");
  tests::look_into_frame(
      scene.geometry, view_of(scene, {32, 32}), 128, [&](const frame::FrameInputs& inputs) {
        const gpu::Limits& all = inputs.context.limits();
        const VolumeOptions settings{.resolution = n, .populate = populate, .scan = scan};
        const auto bits = [&](const gpu::Limits& limits, std::size_t windows, int planes) {
          ShadowVolume volume(limits, settings);
          EXPECT_EQ(volume.grid().windows().size(), windows);
          EXPECT_EQ(volume.grid().windows().front().planes, planes);
          tests::build(volume, inputs, 1.0f);
          const auto first = volume.bits();
          tests::build(volume, inputs, 1.0f);
          EXPECT_TRUE(volume.bits() == first) << "built again";
          return first;
        };
        const std::vector<std::uint32_t> one = bits(all, 1, 37);
        EXPECT_GT(std::count_if(one.begin(), one.end(), [](std::uint32_t word) { return word != 0; }), 100);
        gpu::Limits small_buffers = all;
        // Enough for the light rays, and for the mip chain of eight planes, but not of nine.
        small_buffers.max_storage_block_bytes = 9 * plane_bytes;
        EXPECT_TRUE(bits(small_buffers, 5, 8) == one);
        gpu::Limits small_dispatches = all;
        small_dispatches.max_work_groups.y = 7;
        EXPECT_TRUE(bits(small_dispatches, 6, 7) == one);
      });
}

INSTANTIATE_TEST_SUITE_P(
    Ways, GridWindows,
    testing::Values(Way{Populate::shadow_map, Scan::fused}, Way{Populate::shadow_map, Scan::blocks},
                    Way{Populate::shadow_map, Scan::column}, Way{Populate::shadow_map, Scan::multi_pass},
                    Way{Populate::conservative, Scan::fused}, Way{Populate::conservative, Scan::blocks},
                    Way{Populate::conservative, Scan::column}, Way{Populate::conservative, Scan::multi_pass},
                    Way{Populate::screen_space, Scan::column},
                    Way{Populate::screen_space, Scan::multi_pass}));

TEST(Grid, OfMorePlanesThanADispatchTakesIsFilledInSeveral) {
  gpu::Context& context = tests::gpu_context();
  const std::uint32_t most = context.limits().max_work_groups.y;
  if (most >= 1u << 17) GTEST_SKIP() << "one dispatch of this driver takes any grid";
  const Resolution n{1, static_cast<int>(most) + 1, 128};
  scene::Geometry geometry;
  tests::add_box(geometry, {-1, -1, -1},
                 {1, 1, 1});  // the eye is in it, so that shadow begins there in every plane
  scene::View view = view_of(builtin("sphere"), {8, 8});
  view.camera.eye = {0, 0, 0};
  view.camera.target = {0, 0, -1};
  view.lights[0].position = {0, 0, -3};
  tests::look_into_frame(geometry, view, 8, [&](const frame::FrameInputs& inputs) {
    ShadowVolume volume(context.limits(), {.resolution = n, .populate = Populate::screen_space});
    EXPECT_EQ(volume.grid().windows().size(), 2u);
    volume.find_ranges(inputs);
    volume.fill(inputs);
    const std::vector<std::uint32_t> bits = volume.grid().bits().read<std::uint32_t>();
    for (std::size_t word = 0; word < bits.size(); word += 4)
      ASSERT_EQ(bits[word] & 1u, 1u) << "plane " << word / 4;
  });
  EXPECT_NO_THROW(context.finish());
}

TEST(Grid, RefusesCountsThatCannotBe) {
  for (const Resolution& bad :
       {Resolution{0, 8, 128}, Resolution{8, 0, 128}, Resolution{8, 8, 0}, Resolution{8, 8, 100},
        Resolution{8, 8, 192}, Resolution{-1, 8, 128}, Resolution{8, 1 << 18, 128}}) {
    try {
      validate(bad);
      ADD_FAILURE() << bad.alpha << "x" << bad.theta << "x" << bad.phi;
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.exit_code, scene::ExitCode::usage);
    }
  }
  EXPECT_NO_THROW(validate(Resolution{1, 1, 128}));
}

constexpr float k_growth = 1.5f;

/// A frame's grid on the CPU, and exact rays beside it.
class BitsOf {
 public:
  BitsOf(const scene::Scene& scene, const scene::View& view, const Resolution& n, int shadow_map_size)
      : n_(n),
        axes_(make_axes(glm::normalize(view.lights[0].position - view.camera.eye))),
        D_(glm::distance(view.lights[0].position, view.camera.eye)),
        triangles_(scene.geometry),
        exact_(triangles_, view.lights[0].position, view.camera.eye) {
    tests::look_into_frame(scene.geometry, view, shadow_map_size, [&](const frame::FrameInputs& inputs) {
      ShadowVolume volume(inputs.context.limits(), {.resolution = n, .ranges = Ranges::alpha_phi});
      tests::build(volume, inputs, k_growth);
      bits_ = volume.grid().bits().read<std::uint32_t>();
      phi_max_ = static_cast<double>(tests::phi_cells(volume).front().phi_max);
    });
    alpha_ = alpha_range(scene::camera_frame(view.camera, view.size), axes_.axis);
  }

  double alpha(double i) const { return alpha_.lower + (i + 0.5) * (alpha_.upper - alpha_.lower) / n_.alpha; }
  double theta(double j) const { return (j + 0.5) * 2 * std::numbers::pi / n_.theta - std::numbers::pi; }
  double phi(double k) const {
    const double x = (k + 0.5) / n_.phi, growth = static_cast<double>(k_growth);
    return phi_max_ * x * (1 + growth * x) / (1 + growth);
  }

  bool bit(int i, int j, int k) const { return tests::is_set(bits_, n_, i, j, k); }

  /// Whether the light sees the point (α, θ, φ), which may be infinitely far.
  bool is_shadowed(double alpha, double theta, double phi) const {
    const glm::dvec3 direction =
        std::sin(phi) * (std::cos(theta) * axes_.u + std::sin(theta) * axes_.f) - std::cos(phi) * axes_.axis;
    const double sine = std::sin(alpha + phi);
    LightRays rays{};
    rays.direction_x[0] = static_cast<float>(direction.x);
    rays.direction_y[0] = static_cast<float>(direction.y);
    rays.direction_z[0] = static_cast<float>(direction.z);
    rays.length[0] = sine > 1e-6 && alpha + phi < std::numbers::pi
                         ? static_cast<float>(D_ * std::sin(alpha) / sine)
                         : 1e9f;
    return (exact_.lit(rays, 1, reference::RayMode::single) & 1u) == 0;
  }

 private:
  Resolution n_;
  Axes axes_;
  double D_;
  reference::Triangles triangles_;
  Visibility exact_;
  std::vector<std::uint32_t> bits_;
  Range alpha_{};
  double phi_max_ = 0.0;
};

class GridBits : public testing::TestWithParam<const char*> {};

TEST_P(GridBits, SayWhetherTheirVoxelsCentreIsInShadow) {
  const scene::Scene& scene = builtin(GetParam());
  const Resolution n{256, 512, 256};
  const int texels = 1024;
  const BitsOf grid(scene, view_of(scene, {128, 128}), n, texels);
  tests::Random random(1);
  int wrong = 0, far_from_boundaries = 0;
  const int samples = 50000;
  for (int sample = 0; sample < samples; ++sample) {
    const int i = static_cast<int>(random.uniform(0, n.alpha)),
              j = static_cast<int>(random.uniform(0, n.theta));
    const int k = static_cast<int>(random.uniform(0, n.phi));
    const double alpha = grid.alpha(i), theta = grid.theta(j), phi = grid.phi(k);
    const bool bit = grid.bit(i, j, k);
    if (bit == grid.is_shadowed(alpha, theta, phi)) continue;
    ++wrong;
    // The shadow map answers for the centre of a texel, whose diagonal is up to 2√2/N of an angle away, and
    // single precision rounds occluders to a cell of α.
    const double reach = 2 * std::sqrt(2.0) / texels, step = grid.alpha(1) - grid.alpha(0);
    bool is_near_boundary = false;
    for (int direction = 0; direction < 24 && !is_near_boundary; ++direction) {
      const double turn = direction * std::numbers::pi / 4, radius = reach * (1 + direction / 8) / 3;
      for (double along : {-1.5 * step, 0.0, 1.5 * step}) {
        is_near_boundary =
            is_near_boundary ||
            bit == grid.is_shadowed(std::max(alpha + along, 1e-4),
                                    theta + radius * std::sin(turn) / std::max(std::sin(phi), 1e-2),
                                    std::max(phi + radius * std::cos(turn), 1e-4));
      }
    }
    far_from_boundaries += is_near_boundary ? 0 : 1;
  }
  RecordProperty("wrong", std::to_string(static_cast<double>(wrong) / samples));
  RecordProperty("far_from_boundaries", far_from_boundaries);
  EXPECT_LT(wrong, samples / 500) << "what a texel of 1/1024 of a cube face blurs";
  EXPECT_LE(far_from_boundaries, samples / 10000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GridBits, testing::Values("cornell", "window", "sphere", "half-space"));

}  // namespace
}  // namespace airlight::epipolar
