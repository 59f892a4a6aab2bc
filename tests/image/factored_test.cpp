#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/scenes.h"
#include "support/view_rays.h"

/// `integral=factored`: the unshadowed integral times the lit fraction of the samples.
namespace airlight {
namespace {

tests::VsvSettings factored() {
  return {.integral = media::VsvIntegral::factored};
}

TEST(Factored, IsTheTableWhereNothingCastsShadow) {
  scene::View view = tests::view_of(tests::builtin("empty"), {32, 32});
  view.medium.sigma_s = {0.1f, 0.2f, 0.4f};
  // The last light lies behind the camera: there, rays end within a few cells.
  for (glm::dvec3 offset : {glm::dvec3(0, 0, 0), glm::dvec3(3, 1, 0), glm::dvec3(0, 0, 20)}) {
    view.lights[0].position += offset;
    const auto expected = tests::render_vsv({}, view).airlight;
    EXPECT_LT(tests::error_of(tests::render_vsv({}, view, factored()).airlight, expected).max, 2e-6)
        << "a product of two quotients, each of which GLSL rounds by up to 2.5 ulp";
  }
}

TEST(Factored, IsTheLitFractionOfTheAnglesTimesTheUnshadowedAirlight) {
  // A half-plane y = 0, x < 0 with the light above its edge: dark is where x < 0 and y < 0.
  const scene::Scene& scene = tests::builtin("half-space");
  const scene::View view = tests::view_of(scene, {32, 32});
  const frame::FrameImages images = tests::render_vsv(scene.geometry, view, factored());
  const auto unshadowed = tests::render_vsv({}, view).airlight;
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const glm::dvec3 to_light = view.lights[0].position - camera.eye;
  const auto angle_at_light = [&](glm::dvec3 point) {  // relative to the eye
    return std::atan2(glm::length(glm::cross(to_light, point)), glm::dot(to_light, to_light - point));
  };
  int partly_lit = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < images.airlight.size(); ++i) {
    if (images.distance[i] > 0.0f) continue;
    const glm::dvec3 ray = tests::pixel_ray(camera, view.size, i);
    double fraction = 1.0;
    if (ray.x < 0 && camera.eye.y - camera.eye.x / ray.x * ray.y < 0) {
      const double alpha = std::atan2(glm::length(glm::cross(to_light, ray)), glm::dot(to_light, ray));
      fraction = angle_at_light(-camera.eye.x / ray.x * ray) / (std::numbers::pi - alpha);
      ++partly_lit;
    }
    // The end of the ray and the shadow's edge are each known to a cell in φ, of 512 over at most π; the
    // edge to one in α as well; and the cells of a word of 32 are taken to be equal.
    const double difference = static_cast<double>(images.airlight[i].y / unshadowed[i].y) - fraction;
    EXPECT_NEAR(difference, 0.0, 0.01) << i;
    largest = std::max(largest, std::abs(difference));
  }
  RecordProperty("largest", std::to_string(largest));
  EXPECT_GT(partly_lit, 50);
}

TEST(Factored, IsNearTheTruthAndTheTableIsNearer) {
  const scene::Scene& scene = tests::builtin("cornell");
  const scene::View view = tests::view_of(scene, {48, 48});
  const tests::Truth truth = tests::trace(scene.geometry, view);
  const auto error = tests::error_of(tests::render_vsv(scene.geometry, view, factored()), truth);
  const auto table = tests::error_of(tests::render_vsv(scene.geometry, view), truth);
  RecordProperty("factored", std::to_string(error.rrmse) + ", bias " + std::to_string(error.bias));
  // The shadow is taken to lie anywhere on the ray alike.
  EXPECT_LT(error.rrmse, 0.15);
  EXPECT_LT(std::abs(error.bias), 0.1);
  EXPECT_GT(error.rrmse, 3 * table.rrmse);
}

}  // namespace
}  // namespace airlight
