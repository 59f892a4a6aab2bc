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
  volume.grid().bits().clear(tests::k_rubbish);
  tests::build(volume, inputs, 2.5f);
  return volume.bits();
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
    EXPECT_TRUE(bits_of(inputs, resolution, Scan::blocks) == column);
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
    for (Scan scan : {Scan::fused, Scan::blocks, Scan::column, Scan::multi_pass}) {
      ShadowVolume volume(inputs.context.limits(), {.resolution = n, .scan = scan});
      tests::build(volume, inputs, 1.0f);
      const auto first = volume.bits();
      tests::build(volume, inputs, 1.0f);
      EXPECT_TRUE(volume.bits() == first);
    }
  });
}

/// The largest φ of half-planes in double precision, from the distances that the frame holds.
struct Seen {
  std::vector<double> at_least;  ///< of the pixels that surely lie in it
  std::vector<double> at_most;   ///< with those near a border, of which single precision decides
};

Seen largest_phi(const scene::View& view, const std::vector<float>& distance,
                 const shaders::EpipolarBlock& space, std::size_t planes) {
  const glm::ivec2 size = view.size;
  const scene::CameraFrame camera = scene::camera_frame(view.camera, size);
  const scene::Light& light = view.lights[0];
  const Axes axes = make_axes(scene::direction_to(light, camera.eye));
  const double quarter = 0.5 * camera.half_height / size.y;
  Seen seen{.at_least = std::vector(planes, 0.0), .at_most = std::vector(planes, 0.0)};
  for (std::size_t pixel = 0; pixel < distance.size(); ++pixel) {
    const glm::dvec3 ray = tests::pixel_ray(camera, size, pixel);
    const double sine = std::max(glm::length(glm::cross(axes.axis, ray)), quarter);
    const double cosine = glm::dot(axes.axis, ray);
    const auto t = static_cast<double>(distance[pixel]);
    const double D = glm::distance(light.position, camera.eye);
    const double phi = scene::is_sun(light) ? (t > 0 ? t * sine : static_cast<double>(shaders::k_endless_phi))
                       : t > 0              ? std::atan2(t * sine, D - t * cosine)
                                            : std::atan2(sine, -cosine);
    const double j = tests::cells_of_theta(space, std::atan2(glm::dot(ray, axes.f), glm::dot(ray, axes.u)));
    const auto plane = [&](double cell) {
      // Around the turn, if the grid covers it; else the nearest.
      const auto count = static_cast<double>(planes);
      const bool is_turn = space.theta_half == shaders::k_half_turn;
      cell = is_turn ? cell - count * std::floor(cell / count) : std::clamp(cell, 0.0, count - 0.5);
      return std::min(static_cast<std::size_t>(cell), planes - 1);
    };
    constexpr double k_rounding = 1e-3;
    const std::size_t before = plane(j - k_rounding), after = plane(j + k_rounding);
    for (const std::size_t at : {before, after}) seen.at_most[at] = std::max(seen.at_most[at], phi);
    if (before == after) seen.at_least[before] = std::max(seen.at_least[before], phi);
  }
  return seen;
}

void expect_largest_phi(const scene::Geometry& geometry, const scene::View& view) {
  look_into_frame(geometry, view, 16, [&](const frame::FrameInputs& inputs) {
    constexpr std::size_t k_planes = 8;
    ShadowVolume volume(inputs.context.limits(), {.resolution = {8, k_planes, 128}});
    const shaders::EpipolarBlock space = volume.find_ranges(inputs);
    const Seen expected = largest_phi(view, tests::distances(inputs), space, k_planes);
    const auto range = volume.grid().phi_range().read<float>();
    const auto box = volume.grid().box_ranges().read<glm::vec2>();
    const auto planes = volume.grid().planes().read<glm::vec4>();
    float largest = 0.0f;
    for (std::size_t j = 0; j < k_planes; ++j) {
      const shaders::Angle seen = shaders::phi_from_order(space, shaders::Order(range.at(2 + j)));
      // The order is a single-precision number up to 2; of a sun the length itself.
      const double tolerance = 1e-6 * std::max(expected.at_most[j], 1.0);
      EXPECT_GE(static_cast<double>(seen), expected.at_least[j] - tolerance)
          << view.size.x << "x" << view.size.y << ", plane " << j;
      EXPECT_LE(static_cast<double>(seen), expected.at_most[j] + tolerance)
          << view.size.x << "x" << view.size.y << ", plane " << j;
      // Of that, what the box can shade.
      EXPECT_EQ(planes.at(2 * j + 1).x, box.at(j).x);
      EXPECT_FLOAT_EQ(planes.at(2 * j + 1).y, std::min(box.at(j).y, static_cast<float>(seen)));
      largest = std::max(largest, planes.at(2 * j + 1).y);
    }
    EXPECT_EQ(range.at(0), largest);
  });
}

class PhiRange : public testing::TestWithParam<const char*> {};

TEST_P(PhiRange, OnTheGpuIsTheLargestOnTheCpu) {
  const scene::Scene& scene = builtin(GetParam());
  for (glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(65, 33), glm::ivec2(1, 1), glm::ivec2(1, 40)}) {
    expect_largest_phi(scene.geometry, view_of(scene, size));
  }
}

TEST_P(PhiRange, OfASunIsTheLargestDistanceFromTheAxis) {
  const scene::Scene& scene = builtin(GetParam());
  scene::View view = view_of(scene, {65, 33});
  for (const glm::dvec3& towards : {glm::dvec3(0.3, 1.0, -0.5), glm::dvec3(0.05, 0.1, -1.0)}) {
    view.lights[0] = scene::sun("", towards, glm::vec3(1.0f));
    expect_largest_phi(scene.geometry, view);
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
