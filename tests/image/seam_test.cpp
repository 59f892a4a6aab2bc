#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "support/render.h"
#include "support/view_rays.h"
#include "unit/reference/fixtures.h"

namespace airlight {
namespace {

TEST(Seam, AtPlusMinusPiIsAsGoodAsElsewhere) {
  // Slats all around the light, which is in view: θ takes every value, and shadows cross the seam.
  const scene::Geometry geometry = reference::tests::clutter(150);
  scene::View view = reference::tests::clutter_view(96);
  const tests::Truth truth = tests::trace(geometry, view);
  const frame::FrameImages images = tests::render_vsv(geometry, view, {.resolution = {256, 512, 512}});

  const shaders::EpipolarBlock space = epipolar::epipolar_block(
      view, view.lights[0], {256, 64, 128}, epipolar::Ranges::frame, epipolar::ThetaCells::equal);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  // Bands of 0.2 rad about θ = ±π and about every other multiple of 0.2 rad.
  const int bands = 32;
  std::vector<double> squares(bands, 0.0), sums(bands, 0.0);
  std::vector<int> pixels(bands, 0);
  double mean = 0.0;
  for (std::size_t i = 0; i < images.airlight.size(); ++i) {
    if (std::abs(images.distance[i] - truth.surfaces.distance[i]) > 1e-3f * truth.surfaces.distance[i])
      continue;
    const glm::dvec3 ray = tests::pixel_ray(camera, view.size, i);
    const auto theta = static_cast<double>(shaders::theta_of(space, glm::vec3(ray)));
    const auto band = static_cast<std::size_t>(
        std::lround((theta + std::numbers::pi) / (2 * std::numbers::pi) * bands) % bands);
    const double difference =
        static_cast<double>(images.airlight[i].y) - static_cast<double>(truth.airlight.radiance[i].y);
    squares[band] += difference * difference;
    sums[band] += difference;
    ++pixels[band];
    mean += static_cast<double>(truth.airlight.radiance[i].y) / static_cast<double>(images.airlight.size());
  }
  std::vector<double> rmse;
  for (std::size_t band = 0; band < bands; ++band) {
    ASSERT_GT(pixels[band], 50) << band;
    rmse.push_back(std::sqrt(squares[band] / pixels[band]) / mean);
  }
  std::vector<double> sorted = rmse;
  std::sort(sorted.begin(), sorted.end());
  // Band 0 holds both sides of the seam.
  EXPECT_LT(rmse[0], 2 * sorted[bands / 2]) << "the median of all bands";
  EXPECT_LT(std::abs(sums[0] / pixels[0]) / mean, 0.01);
  RecordProperty("seam", std::to_string(rmse[0]));
  RecordProperty("median", std::to_string(sorted[bands / 2]));
}

}  // namespace
}  // namespace airlight
