#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "support/render.h"
#include "support/scenes.h"
#include "support/view_rays.h"
#include "unit/reference/fixtures.h"

/// Scenes whose airlight is known without a renderer: the integral over the distance along each view ray,
/// between the ends of its lit part, by a quadrature that knows nothing of epipolar space.
namespace airlight {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

struct Lit {
  double from, to;
};

/// The airlight of a ray that is lit over these intervals of distance, but for a ray within a quarter pixel
/// of the light.
double airlight(const scene::View& view, glm::dvec3 ray, const std::vector<Lit>& lit) {
  const glm::dvec3 to_light = view.lights[0].position - view.camera.eye;
  const double alpha = std::atan2(glm::length(glm::cross(to_light, ray)), glm::dot(to_light, ray));
  double sum = 0.0;
  for (const Lit& part : lit)
    sum += reference::tests::airlight_over_distance(view, alpha, part.from, part.to).x;
  return sum;
}

template <class LitParts>
std::vector<glm::vec3> expected_image(const scene::View& view, const LitParts& lit_parts) {
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  std::vector<glm::vec3> image;
  for (int y = 0; y < view.size.y; ++y) {
    for (int x = 0; x < view.size.x; ++x) {
      const glm::dvec3 ray = tests::pixel_ray(camera, view.size, x, y);
      image.emplace_back(static_cast<float>(airlight(view, ray, lit_parts(camera.eye, ray))));
    }
  }
  return image;
}

class ClosedForm : public testing::TestWithParam<media::VsvIntegral> {
 protected:
  tests::VsvSettings settings() const { return {.resolution = {256, 1024, 512}, .integral = GetParam()}; }
};

TEST_P(ClosedForm, EmptyFogGlowsAroundTheLamp) {
  for (scene::PhaseFunction phase :
       {scene::PhaseFunction::isotropic, scene::PhaseFunction::rayleigh,
        scene::PhaseFunction::henyey_greenstein, scene::PhaseFunction::hoffman_preetham}) {
    scene::View view = tests::view_of(tests::builtin("empty"), {16, 16});
    view.medium.phase = phase;
    view.medium.g = 0.6f;
    view.medium.rayleigh_weight = 0.3f;
    const auto expected = expected_image(view, [](glm::dvec3, glm::dvec3) {
      return std::vector<Lit>{{0, k_infinity}};
    });
    const auto error = tests::error_of(tests::render_vsv({}, view, settings()).airlight, expected);
    // Quadrature by two points a cell, and interpolation between 256 rows of the table.
    EXPECT_LT(error.max, 1e-3);
    EXPECT_LT(std::abs(error.bias), 5e-4);
    RecordProperty("max", std::to_string(error.max));
  }
}

TEST_P(ClosedForm, AHalfPlaneCutsTheLightAtItsEdgesPlane) {
  const scene::Scene& scene = tests::builtin("half-space");
  const scene::View view = tests::view_of(scene, {24, 24});
  const auto expected = expected_image(view, [](glm::dvec3 eye, glm::dvec3 ray) {
    // The occluder is y = 0, x < 0 and the light above its edge: dark is where x < 0 and y < 0.
    if (ray.x >= 0) return std::vector<Lit>{{0, k_infinity}};
    const double edge = -eye.x / ray.x, height_at_edge = eye.y + edge * ray.y;
    return std::vector<Lit>{{0, height_at_edge < 0 ? edge : k_infinity}};
  });
  const auto error = tests::error_of(tests::render_vsv(scene.geometry, view, settings()).airlight, expected);
  // A shadow's edge is misplaced by up to half a cell of φ (φ_max/512) or of α, and the shadow map's by half
  // a texel.
  EXPECT_LT(error.rrmse, 1e-2);
  EXPECT_LT(error.p99, 1.5e-2);
  EXPECT_LT(std::abs(error.bias), 2e-3);
  RecordProperty("rrmse", std::to_string(error.rrmse));
}

TEST_P(ClosedForm, ASphereCastsACone) {
  const scene::Scene& scene = tests::builtin("sphere");
  const scene::View view = tests::view_of(scene, {24, 24});
  const double radius = 1.0;  // around the origin
  const auto expected = expected_image(view, [&](glm::dvec3 eye, glm::dvec3 ray) {
    const glm::dvec3 light = view.lights[0].position;
    const auto is_dark = [&](double t) {
      const glm::dvec3 d = eye + t * ray - light;
      const double nearest = std::clamp(-glm::dot(light, d) / glm::dot(d, d), 0.0, 1.0);
      return glm::length(light + nearest * d) < radius;
    };
    // The ray ends on the sphere, where it meets it.
    const double b = glm::dot(eye, ray), discriminant = b * b - glm::dot(eye, eye) + radius * radius;
    const double end = discriminant > 0 && b < 0 ? -b - std::sqrt(discriminant) : 1e4;
    // The dark part of a line is one interval: find its ends by steps, then by halving.
    std::vector<Lit> lit;
    double lit_from = 0.0, last = 0.0;
    bool was_dark = is_dark(0.0);
    const int steps = 4000;
    for (int i = 1; i <= steps; ++i) {
      const double t = end * std::pow(static_cast<double>(i) / steps, end > 100 ? 4 : 1) * (1 - 1e-9);
      if (is_dark(t) != was_dark) {
        double before = last, after = t;
        for (int halving = 0; halving < 50; ++halving) {
          const double middle = 0.5 * (before + after);
          (is_dark(middle) == was_dark ? before : after) = middle;
        }
        if (!was_dark) lit.push_back({lit_from, before});
        lit_from = after;
        was_dark = !was_dark;
      }
      last = t;
    }
    if (!was_dark) lit.push_back({lit_from, end > 100 ? k_infinity : end});
    return lit;
  });
  const auto error = tests::error_of(tests::render_vsv(scene.geometry, view, settings()).airlight, expected);
  // As for the half-plane; and the sphere is made of 20,480 flat triangles.
  EXPECT_LT(error.rrmse, 1e-2);
  EXPECT_LT(error.p99, 1.5e-2);
  EXPECT_LT(std::abs(error.bias), 2e-3);
  RecordProperty("rrmse", std::to_string(error.rrmse));
}

INSTANTIATE_TEST_SUITE_P(Integrals, ClosedForm,
                         testing::Values(media::VsvIntegral::table, media::VsvIntegral::quadrature,
                                         media::VsvIntegral::riemann),
                         [](const auto& test) { return tests::name_of(test.param); });

TEST(EmptyFog, EqualsTheReferenceInEveryChannelWithLightInFrontAndBehind) {
  scene::View view;
  view.camera.target = {0, 0, -1};
  view.camera.vertical_fov_degrees = 50;
  view.medium = {.sigma_s = {0.1f, 0.3f, 0.05f}, .sigma_a = {0.02f, 0.0f, 0.4f}};
  view.lights[0].intensity = {3, 2, 1};
  view.size = {48, 48};
  for (glm::dvec3 light :
       {glm::dvec3(0.2, 0.1, -3), glm::dvec3(2, 1, 0.3), glm::dvec3(0.3, -0.2, 4), glm::dvec3(-1, 5, -2)}) {
    view.lights[0].position = light;
    const auto exact = reference::Reference({}, view).exact();
    const auto image = tests::render_vsv({}, view).airlight;
    for (std::size_t i = 0; i < image.size(); ++i) {
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(image[i][channel] / exact.radiance[i][channel], 1.0f, 2e-3f)
            << "light " << light.x << " " << light.y << " " << light.z << " pixel " << i;
      }
    }
    EXPECT_LT(std::abs(tests::error_of(image, exact.radiance).bias), 1e-3);
  }
}

}  // namespace
}  // namespace airlight
