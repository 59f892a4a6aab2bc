#include "epipolar/debug_images.h"

#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "support/frame_probe.h"
#include "support/grid_bits.h"
#include "support/scenes.h"
#include "support/view_rays.h"

namespace airlight::epipolar {
namespace {

using tests::builtin;
using tests::view_of;

struct Debugged {
  frame::DebugImage before, after, samples;
  std::vector<std::uint32_t> bits;  ///< after the scan
  std::vector<glm::vec4> surfaces;
  shaders::EpipolarBlock space;
  std::vector<shaders::PhiCells> cells;  ///< of each half-plane
};

Debugged debug(const char* scene, glm::ivec2 size, const VolumeOptions& settings) {
  Debugged debugged;
  const scene::Geometry& geometry = builtin(scene).geometry;
  const scene::View view = view_of(builtin(scene), size);
  tests::look_into_frame(geometry, view, 512, [&](const frame::FrameInputs& inputs) {
    ShadowVolume volume(inputs.context.limits(), settings);
    volume.grid().bits().clear(tests::k_rubbish);
    debugged.space = volume.find_ranges(inputs);
    volume.fill(inputs);
    debugged.bits = volume.bits();
    debugged.surfaces = inputs.surfaces.read<glm::vec4>();
    debugged.cells = tests::phi_cells(volume);
    const std::vector<frame::DebugImage> images = debug_images(volume, inputs);
    ASSERT_EQ(images.size(), 3u);
    debugged.before = images[0];
    debugged.after = images[1];
    debugged.samples = images[2];
  });
  EXPECT_EQ(debugged.before.name, "grid_before_scan");
  EXPECT_EQ(debugged.after.name, "grid_after_scan");
  EXPECT_EQ(debugged.samples.name, "shadowed_samples");
  return debugged;
}

const VolumeOptions k_small = {.resolution = {64, 128, 256}};

TEST(DebugImages, OfTheGridCountItsBits) {
  const Debugged debugged = debug("window", {48, 32}, k_small);
  ASSERT_EQ(debugged.after.size, glm::ivec2(64, 128));
  ASSERT_EQ(debugged.after.values.size(), 64u * 128u);
  for (std::size_t ray = 0; ray < debugged.after.values.size(); ++ray) {
    const std::size_t set = tests::count_set(std::span(debugged.bits).subspan(8 * ray, 8));
    ASSERT_EQ(debugged.after.values[ray], static_cast<float>(set) / 256.0f) << ray;
  }
}

TEST(DebugImages, OfAnUnscannedGridHoldWhatTheScanDrawsOut) {
  for (Scan scan : {Scan::fused, Scan::blocks, Scan::column, Scan::multi_pass}) {
    VolumeOptions settings = k_small;
    settings.scan = scan;
    const Debugged debugged = debug("window", {48, 32}, settings);
    // A light ray has at most one bit before the scan, so that along a row the sums of the one are the other.
    for (std::size_t row = 0; row < 128; ++row) {
      float sum = 0.0f;
      for (std::size_t i = row * 64; i < (row + 1) * 64; ++i) {
        sum += debugged.before.values[i];
        ASSERT_GE(debugged.after.values[i], debugged.before.values[i]);
        ASSERT_EQ(debugged.after.values[i], sum) << i;
      }
      EXPECT_GT(sum, 0.0f);
    }
  }
}

TEST(DebugImages, CountTheShadowedSamplesOfEachPixel) {
  const glm::ivec2 size(48, 32);
  for (const auto& [scene, scan] : {std::pair{"window", Scan::fused}, std::pair{"window", Scan::blocks},
                                    std::pair{"sphere", Scan::fused}}) {
    VolumeOptions settings = k_small;
    settings.scan = scan;
    const Debugged debugged = debug(scene, size, settings);
    ASSERT_EQ(debugged.samples.size, size);
    const scene::View view = view_of(builtin(scene), size);
    const scene::CameraFrame camera = scene::camera_frame(view.camera, size);
    const glm::dvec3 axis(debugged.space.axis), u(debugged.space.u), f(debugged.space.f);
    const double distance = glm::distance(view.lights[0].position, view.camera.eye);
    int counted = 0, shadowed = 0;
    for (std::size_t pixel = 0; pixel < debugged.surfaces.size(); ++pixel) {
      const glm::dvec3 ray = tests::pixel_ray(camera, size, pixel);
      const double sine = glm::length(glm::cross(axis, ray)), cosine = glm::dot(axis, ray);
      const double t = static_cast<double>(debugged.surfaces[pixel].w);
      const double phi = t > 0 ? std::atan2(t * sine, distance - t * cosine) : std::atan2(sine, -cosine);
      const double i = tests::cells_of_alpha(debugged.space, std::atan2(sine, cosine));
      const double j = tests::cells_of_theta(debugged.space, std::atan2(glm::dot(ray, f), glm::dot(ray, u)));
      const double end = tests::cells_of_phi(debugged.cells.at(static_cast<std::size_t>(j)), phi);
      // Single precision may put a number that is near a border on its other side.
      const auto is_near_border = [](double v) { return std::abs(v - std::round(v)) < 1e-2; };
      if (is_near_border(i) || is_near_border(j) || is_near_border(end - 0.5)) continue;
      int set = 0;
      for (int k = 0; k < 256 && k + 0.5 < end; ++k)
        set += tests::is_set(debugged.bits, k_small.resolution, static_cast<int>(i), static_cast<int>(j), k);
      EXPECT_EQ(debugged.samples.values[pixel], static_cast<float>(set) / 256.0f)
          << scene << ", pixel " << pixel;
      ++counted;
      shadowed += set > 0;
    }
    EXPECT_GT(counted, size.x * size.y * 9 / 10);
    EXPECT_GT(shadowed, size.x * size.y / 20) << scene;
  }
}

TEST(DebugImages, OfALongGridAreAveraged) {
  // On llvmpipe this grid is also larger than one storage buffer.
  const Debugged debugged = debug("window", {16, 16}, {.resolution = {512, 5000, 512}});
  EXPECT_EQ(debugged.after.size, glm::ivec2(512, 2500));
  for (std::size_t pixel : {std::size_t{300}, std::size_t{512 * 1250 + 100}, std::size_t{512 * 2499 + 511}}) {
    std::size_t set = 0;
    for (std::size_t row = 0; row < 2; ++row) {
      const std::size_t ray = (pixel / 512 * 2 + row) * 512 + pixel % 512;
      set += tests::count_set(std::span(debugged.bits).subspan(16 * ray, 16));
    }
    EXPECT_EQ(debugged.after.values[pixel], static_cast<float>(set) / 1024.0f) << pixel;
  }
  const Debugged odd = debug("window", {16, 16}, {.resolution = {4097, 3, 128}});
  EXPECT_EQ(odd.after.size, glm::ivec2(2049, 3));
  const std::size_t set = tests::count_set(std::span(odd.bits).subspan(4096 * 4, 4));
  EXPECT_EQ(odd.after.values[2048], static_cast<float>(set) / 128.0f) << "the last column stands alone";
}

}  // namespace
}  // namespace airlight::epipolar
