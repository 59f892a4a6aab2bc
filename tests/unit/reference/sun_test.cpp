#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "quality/metrics.h"
#include "reference/sun_fog.h"
#include "reference/sun_ray.h"
#include "support/random.h"
#include "unit/reference/fixtures.h"

/// Suns, in endless fog and in a layer of it, against integrals over the distance by another quadrature, and
/// against far lamps.
namespace airlight::reference {
namespace {

using airlight::tests::Random;
using tests::integrate;

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// Rounding of images to single precision.
constexpr double k_single = 3e-7;

const glm::dvec3 k_eye(0.5, 1.0, 2.0);

/// A view of one pixel, 0.01° high.
scene::View pixel_view(const glm::dvec3& direction, const glm::dvec3& sun, std::optional<double> top) {
  scene::View view;
  view.camera.eye = k_eye;
  view.camera.target = k_eye + direction;
  view.camera.up = std::abs(direction.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  view.camera.vertical_fov_degrees = 0.01;
  view.lights[0] = scene::sun("sun", sun, {2, 3, 5});
  view.medium.sigma_s = {0.02f, 0.3f, 2.0f};
  view.medium.sigma_a = {0.0f, 0.1f, 0.5f};
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = 0.5f;
  view.medium.top = top;
  view.size = {1, 1};
  return view;
}

/// The airlight of the part of a one-pixel view's ray between two distances from the eye, every point of it
/// lit: σ_s E p ∫ e^{−σ (a + b)} dt over what lies in the medium, b the sun's path to the point, a the
/// point's to the eye.
glm::dvec3 expected_radiance(const scene::View& view, double t_from, double t_to) {
  const glm::dvec3 w = glm::normalize(view.camera.target - view.camera.eye), l = view.lights[0].towards;
  const std::optional<double> top = view.medium.top;
  const auto above = [&](double t) { return top ? (view.camera.eye + t * w).y - *top : -k_infinity; };
  if (top && w.y != 0.0) {
    const double passed = (*top - view.camera.eye.y) / w.y;
    if (above(t_from) > 0.0) t_from = passed > t_from ? passed : k_infinity;
    if (w.y > 0.0) t_to = std::min(t_to, passed);
  } else if (above(t_from) > 0.0) {
    t_from = k_infinity;
  }
  const double entered = above(0.0) > 0.0 ? (*top - view.camera.eye.y) / w.y : 0.0;
  glm::dvec3 radiance(0.0);
  if (!(t_from < t_to)) return radiance;
  for (int channel = 0; channel < 3; ++channel) {
    const auto sigma_s = static_cast<double>(view.medium.sigma_s[channel]);
    const double sigma_t = sigma_s + static_cast<double>(view.medium.sigma_a[channel]);
    const double scale = sigma_s * phase(view.medium, glm::dot(w, l)) *
                         static_cast<double>(view.lights[0].irradiance[channel]);
    const auto depth = [&](double t) {
      return sigma_t * (t - entered + (top ? std::max(-above(t), 0.0) / l.y : 0.0));
    };
    // The slope is even all along: an endless ray ends where it has lost e^{−40}.
    const double slope = depth(t_from + 1.0) - depth(t_from);
    const double end = std::isinf(t_to) ? t_from + 40.0 / slope : t_to;
    const double least = std::min(depth(t_from), depth(end));
    const double sum = integrate([&](double t) { return std::exp(least - depth(t)); }, t_from, end, 1e-12);
    radiance[channel] = scale * std::exp(-least) * sum;
  }
  return radiance;
}

void expect_near(const AirlightImage& image, const glm::dvec3& expected, double tolerance,
                 const std::string& what) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(static_cast<double>(image.radiance[0][channel]), expected[channel],
                std::max(tolerance * expected[channel], 1e-37))
        << what << ", channel " << channel;
  }
}

std::string text(const glm::dvec3& v) {
  return std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z);
}

const glm::dvec3 k_suns[] = {{0, 1, 0}, {0.35, 1, 0.15}, {-0.5, 0.6, 1}, {1, 0.02, -0.3}};
const glm::dvec3 k_directions[] = {{0, 1, 0},      {0, -1, 0},      {0, 0, -1},    {1, 0, 0.3},
                                   {0.2, 0.5, -1}, {-1, 0.01, 0.3}, {0.3, -0.4, 1}};
const std::optional<double> k_tops[] = {{}, 6.0, 1.001, 1.0, 0.999, -3.0};

TEST(Sun, EmptyFogMatchesTheIntegralOverDistance) {
  for (const glm::dvec3& sun : k_suns) {
    for (const glm::dvec3& towards : k_directions) {
      const glm::dvec3 direction = glm::normalize(towards);
      if (glm::length(glm::cross(direction, sun)) < 1e-3) continue;
      for (const std::optional<double>& top : k_tops) {
        const scene::View view = pixel_view(direction, sun, top);
        expect_near(Reference({}, view).exact(), expected_radiance(view, 0.0, k_infinity), k_single,
                    "sun " + text(sun) + ", towards " + text(direction) + ", top " +
                        (top ? std::to_string(*top) : "none"));
      }
    }
  }
}

TEST(Sun, ByHandStraightUpFromTheGroundUnderTheZenith) {
  // A ray up across the light of a sun at 30° of height: the sun's path falls by 2 m a metre, the ray's grows
  // by one.
  scene::View view = pixel_view({0, 1, 0}, {std::sqrt(3.0), 1, 0}, 6.0);
  view.medium = {.sigma_s = glm::vec3(0.2f), .top = 6.0};
  const double sigma = static_cast<double>(0.2f), height = 5.0;
  const double expected = sigma * 2.0 / (4.0 * std::numbers::pi) * std::exp(-sigma * height) *
                          (1.0 - std::exp(-sigma * height)) / sigma;
  EXPECT_NEAR(static_cast<double>(Reference({}, view).exact().radiance[0].r) / expected, 1.0, k_single);
}

TEST(Sun, AtItAndAwayFromIt) {
  // At the sun the ray is moved by a quarter pixel, away from it by 1e-6.
  for (const glm::dvec3& sun : k_suns) {
    for (double side : {1.0, -1.0}) {
      for (const std::optional<double>& top : {std::optional<double>(), std::optional(6.0)}) {
        const scene::View view = pixel_view(side * glm::normalize(sun), sun, top);
        expect_near(Reference({}, view).exact(), expected_radiance(view, 0.0, k_infinity), 1e-3,
                    "sun " + text(sun) + (side > 0.0 ? " ahead" : " behind"));
      }
    }
  }
}

TEST(SunFog, HasNoGapWhereTheDepthStandsStill) {
  // View rays near the sun's own direction: the slope is 0 there, and the light even along the ray.
  const glm::dvec3 l = glm::normalize(glm::dvec3(0.3, 0.6, 0.2));
  const scene::Medium medium{.sigma_s = glm::vec3(0.4f), .sigma_a = glm::vec3(0.1f), .top = 0.0};
  const double sigma_t = static_cast<double>(0.4f) + static_cast<double>(0.1f);
  SunRay ray = make_sun_ray(l, {0, 0, 1}, {1, 0, 0}, 0.0, 1e-6, -7.0);
  ray.to = 9.0;
  const double flat = static_cast<double>(0.4f) * phase(medium, ray.cos_alpha) * 3.0;
  for (double slope :
       {0.0, 1e-16, -1e-16, 1e-11, -1e-11, 2e-9, -2e-9, 3e-9, 1e-6, -1e-6, 1e-3, -1e-3, -0.5}) {
    ray.slope = slope;
    const double k = sigma_t * slope, length = 6.0;
    // (1 − e^{−x})/x by its series, to x¹⁶/17!.
    double term = 1.0, series = 0.0;
    for (int i = 0; i < 17; ++i) {
      series += term;
      term *= -k * length / (i + 2);
    }
    const double expected = flat * std::exp(-sigma_t * (ray.path + slope * 2.0)) * length * series;
    EXPECT_NEAR(SunFog(ray, medium, glm::dvec3(3.0)).radiance(2.0, 8.0).r / expected, 1.0,
                2e-15 + 1e-9 * std::abs(slope))
        << slope;
  }
}

TEST(SunFog, LosesNoDigitsInThickFog) {
  // Against the slope, from where next to nothing arrives to where all does.
  const glm::dvec3 l = glm::normalize(glm::dvec3(1.0, 0.05, 0.0));
  const scene::Medium thin{.sigma_s = glm::vec3(5.0f), .sigma_a = glm::vec3(0.0f), .top = 0.0};
  const SunRay ray = make_sun_ray(l, {0, 1, 0}, {1, 0, 0}, 0.0, 1e-6, -100.0);
  const double sum = SunFog(ray, thin, glm::dvec3(1.0)).radiance(0.0, 100.0).r;
  EXPECT_NEAR(sum / (phase(thin, ray.cos_alpha) * std::exp(-500.0) / std::abs(ray.slope)), 1.0, 1e-11);
}

}  // namespace
}  // namespace airlight::reference
