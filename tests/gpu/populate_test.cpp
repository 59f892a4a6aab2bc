#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "epipolar/volume.h"
#include "support/frame_probe.h"
#include "support/grid_bits.h"
#include "support/scenes.h"
#include "support/view_rays.h"

/// PopulateShadowMap with every scan, and the range of φ that it needs.
namespace airlight::epipolar {
namespace {

using tests::builtin;
using tests::look_into_frame;
using tests::view_of;

std::vector<std::uint32_t> bits_of(const frame::FrameInputs& inputs, const Resolution& resolution,
                                   Scan scan) {
  ShadowVolume volume(inputs.context.limits(), {.resolution = resolution, .scan = scan});
  tests::build(volume, inputs, 2.5f);
  return volume.grid().bits().read<std::uint32_t>();
}

struct Case {
  const char* scene;
  Resolution resolution;
};

void PrintTo(const Case& c, std::ostream* stream) {
  *stream << c.scene << " " << c.resolution.alpha << "x" << c.resolution.theta << "x" << c.resolution.phi;
}

class ScansOf : public testing::TestWithParam<Case> {};

TEST_P(ScansOf, AllWriteTheSameBits) {
  const auto& [name, resolution] = GetParam();
  const scene::Scene& scene = builtin(name);
  look_into_frame(scene.geometry, view_of(scene, {64, 48}), 128, [&](const frame::FrameInputs& inputs) {
    const std::vector<std::uint32_t> fused = bits_of(inputs, resolution, Scan::fused);
    const std::vector<std::uint32_t> column = bits_of(inputs, resolution, Scan::column);
    EXPECT_TRUE(fused == column);
    EXPECT_TRUE(bits_of(inputs, resolution, Scan::multi_pass) == column);
    const std::size_t set = tests::count_set(fused);
    const std::size_t all = 32 * fused.size();
    if (scene.geometry.triangles.empty()) {
      EXPECT_EQ(set, 0u);
    } else {
      EXPECT_GT(set, all / 100);
      EXPECT_LT(set, all - all / 100);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScansOf,
                         testing::Values(Case{"cornell", {64, 64, 128}}, Case{"cornell", {13, 77, 640}},
                                         Case{"cornell", {1, 3, 128}}, Case{"cornell", {512, 101, 256}},
                                         Case{"window", {100, 333, 384}}, Case{"window", {7, 256, 512}},
                                         Case{"sphere", {63, 65, 640}}, Case{"sphere", {8, 64, 128}},
                                         Case{"half-space", {65, 31, 128}}, Case{"empty", {20, 20, 128}}));

TEST(Populate, OnceSetBitsStaySetAlongTheLightRay) {
  const Resolution n{40, 50, 128};
  const scene::Scene& scene = builtin("window");
  look_into_frame(scene.geometry, view_of(scene, {64, 64}), 256, [&](const frame::FrameInputs& inputs) {
    const std::vector<std::uint32_t> bits = bits_of(inputs, n, Scan::fused);
    const std::size_t words = 4;
    for (std::size_t j = 0; j < 50; ++j) {
      for (std::size_t at = j * 40 * words + words; at < (j + 1) * 40 * words; ++at) {
        EXPECT_EQ(bits[at - words] & ~bits[at], 0u);
      }
    }
  });
}

TEST(Populate, BuildingTwiceGivesTheSameBits) {
  const Resolution n{40, 50, 128};
  const scene::Scene& scene = builtin("window");
  look_into_frame(scene.geometry, view_of(scene, {64, 64}), 256, [&](const frame::FrameInputs& inputs) {
    for (Scan scan : {Scan::fused, Scan::column, Scan::multi_pass}) {
      ShadowVolume volume(inputs.context.limits(), {.resolution = n, .scan = scan});
      tests::build(volume, inputs, 1.0f);
      const auto first = volume.grid().bits().read<std::uint32_t>();
      tests::build(volume, inputs, 1.0f);
      EXPECT_TRUE(volume.grid().bits().read<std::uint32_t>() == first);
    }
  });
}

/// φ_max of a view in double precision, from the distances that the frame holds.
double largest_phi(const scene::View& view, const std::vector<float>& distance) {
  const glm::ivec2 size = view.size;
  const scene::CameraFrame camera = scene::camera_frame(view.camera, size);
  const glm::dvec3 to_light = view.lights[0].position - camera.eye;
  const double D = glm::length(to_light), quarter = 0.5 * camera.half_height / size.y;
  double largest = 0.0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec3 ray = tests::pixel_ray(camera, size, x, y);
      const double sine = std::max(glm::length(glm::cross(to_light, ray)) / D, quarter);
      const double cosine = glm::dot(to_light, ray) / D;
      const auto t = static_cast<double>(distance[static_cast<std::size_t>(y * size.x + x)]);
      largest = std::max(largest, t > 0 ? std::atan2(t * sine, D - t * cosine) : std::atan2(sine, -cosine));
    }
  }
  return largest;
}

void expect_largest_phi(const scene::Geometry& geometry, const scene::View& view) {
  look_into_frame(geometry, view, 16, [&](const frame::FrameInputs& inputs) {
    const ShadowVolume volume(inputs.context.limits(), {.resolution = {8, 8, 128}});
    volume.find_ranges(inputs);
    const auto order = volume.grid().phi_range().read<shaders::Order>().at(0);
    // The order is a single-precision number up to 2.
    EXPECT_NEAR(static_cast<double>(shaders::angle_from_order(order)),
                largest_phi(view, tests::distances(inputs)), 1e-6)
        << view.size.x << "x" << view.size.y;
  });
}

class PhiRange : public testing::TestWithParam<const char*> {};

TEST_P(PhiRange, OnTheGpuIsTheLargestOnTheCpu) {
  const scene::Scene& scene = builtin(GetParam());
  for (glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(65, 33), glm::ivec2(1, 1), glm::ivec2(1, 40)}) {
    expect_largest_phi(scene.geometry, view_of(scene, size));
  }
}

TEST_P(PhiRange, IsFoundInWhicheverPixelItIs) {
  // The ray nearest to the light, or the surface nearest to it, lies anywhere in the image.
  const scene::Scene& scene = builtin(GetParam());
  scene::View view = view_of(scene, {70, 70});
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  for (int i = 0; i < 35; ++i) {
    const double x = (2 * ((i * 13) % 35) + 1) / 35.0 - 1, y = (2 * i + 1) / 35.0 - 1;
    view.lights[0].position = camera.eye + 0.9 * (camera.forward + x * camera.half_width * camera.right +
                                                  y * camera.half_height * camera.up);
    expect_largest_phi(scene.geometry, view);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PhiRange,
                         testing::Values("cornell", "window", "sphere", "half-space", "empty"));

}  // namespace
}  // namespace airlight::epipolar
