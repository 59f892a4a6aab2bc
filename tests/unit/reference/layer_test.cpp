#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"
#include "unit/reference/fixtures.h"

/// Point lights in a layer of fog, against the integral over the distance of what geometry says the light's
/// path in the layer is.
namespace airlight::reference {
namespace {

using airlight::tests::Random;
using tests::integrate;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// The length of a segment that lies below a height [m].
double length_below(double top, const glm::dvec3& a, const glm::dvec3& b) {
  const double length = glm::distance(a, b), lower = std::min(a.y, b.y), upper = std::max(a.y, b.y);
  if (upper <= top) return length;
  return lower >= top ? 0.0 : length * (top - lower) / (upper - lower);
}

/// The airlight of an image of one pixel, without shadows: ∫ σ_s e^{−σ(a+b)} p I/r² dt.
glm::dvec3 expected_radiance(const scene::View& view, double distance) {
  const glm::dvec3 eye = view.camera.eye, w = glm::normalize(view.camera.target - eye);
  const glm::dvec3 light = view.lights[0].position;
  const double top = *view.medium.top;
  // The layer's part of the ray.
  const double passed = w.y == 0.0 ? k_infinity : (top - eye.y) / w.y;
  double from = 0.0, to = distance;
  if (eye.y > top) {
    if (w.y >= 0.0) return glm::dvec3(0.0);
    from = passed;
  } else if (w.y > 0.0) {
    to = std::min(to, passed);
  }
  glm::dvec3 radiance(0.0);
  const double nearest = glm::dot(light - eye, w), aside = glm::length(light - eye - nearest * w);
  for (int channel = 0; channel < 3; ++channel) {
    const auto sigma_s = static_cast<double>(view.medium.sigma_s[channel]);
    const double sigma_t = sigma_s + static_cast<double>(view.medium.sigma_a[channel]);
    const auto integrand = [&](double t) {
      const glm::dvec3 point = eye + t * w;
      const double r = glm::distance(point, light);
      const double depth = sigma_t * (t - from + length_below(top, point, light));
      return sigma_s * std::exp(-depth) * phase(view.medium, glm::dot(w, light - point) / r) *
             static_cast<double>(view.lights[0].intensity[channel]) / (r * r);
    };
    const double end = std::isinf(to) ? from + 60.0 / sigma_t : to;
    std::vector<double> ends{from};
    for (double offset : {-100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0}) {
      const double t = nearest + offset * aside;
      if (t > ends.back() && t < end) ends.push_back(t);
    }
    // Where it may fall or rise fast: on the way in, and near the top.
    for (double part : {1e-3, 1e-2, 0.1, 0.5, 0.9, 0.99, 0.999}) {
      const double t = from + part * (end - from);
      ends.push_back(t);
    }
    ends.push_back(end);
    std::sort(ends.begin(), ends.end());
    double estimate = 0.0;
    for (double tolerance : {1e-4, 1e-10}) {
      double sum = 0.0;
      for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        sum += integrate(integrand, ends[i], ends[i + 1],
                         tolerance == 1e-4 ? 1e-4 * integrand(ends[i]) * (ends[i + 1] - ends[i]) + 1e-300
                                           : tolerance * estimate);
      estimate = sum;
    }
    radiance[channel] = estimate;
  }
  return radiance;
}

scene::View random_view(Random& random) {
  scene::View view;
  view.camera.eye = random.in_box(3.0);
  glm::dvec3 w = random.direction();
  if (random.uniform() < 0.2) w = glm::normalize(glm::dvec3(w.x, 0.0, w.z));
  view.camera.target = view.camera.eye + w;
  view.camera.up = random.direction();
  view.camera.vertical_fov_degrees = 0.01;
  view.lights[0] = scene::point_light("", random.in_box(5.0), {2, 3, 5});
  view.medium.sigma_s = {0.02f, 0.3f, 2.0f};
  view.medium.sigma_a = {0.0f, 0.1f, 0.5f};
  view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  view.medium.g = static_cast<float>(random.uniform(-0.6, 0.6));
  view.medium.top = random.uniform(-3.0, 3.0);
  view.size = {1, 1};
  return view;
}

TEST(Layer, OfALampMatchesTheIntegralOverDistance) {
  Random random(7);
  int lit = 0, from_above = 0, into_fog = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const scene::View view = random_view(random);
    const glm::dvec3 expected = expected_radiance(view, k_infinity);
    const Reference reference({}, view);
    const AirlightImage exact = reference.exact();
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(static_cast<double>(exact.radiance[0][channel]), expected[channel],
                  std::max(1e-6 * expected[channel], 1e-37))
          << trial << ", channel " << channel;
    }
    const bool is_lit = expected.r > 0.0;
    lit += is_lit ? 1 : 0;
    from_above += is_lit && view.lights[0].position.y > *view.medium.top ? 1 : 0;
    into_fog += is_lit && view.camera.eye.y > *view.medium.top ? 1 : 0;
    EXPECT_EQ(reference.sampled(16).radiance[0], exact.radiance[0]) << trial;
    // The midpoint rule's error falls with the square of the step, relative to the fog's thickness.
    const glm::vec3 marched = reference.march(4096, RayMode::packet).radiance[0];
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(static_cast<double>(marched[channel]), expected[channel],
                  std::max((channel == 0 ? 1e-5 : 3e-2) * expected[channel], 1e-30))
          << trial << ", channel " << channel;
    }
  }
  EXPECT_GT(lit, 200);
  EXPECT_GT(from_above, 50);
  EXPECT_GT(into_fog, 30);
}

TEST(Layer, HoldsLightAboveADeeperDark) {
  // A lamp far off and barely over the top: on the way up the light's path first grows, by an optical depth
  // of 63, then shrinks by 70.
  scene::View view;
  view.camera.eye = {0, -500, 0};
  view.camera.target = {0, -499.5, std::sqrt(0.75)};
  view.camera.vertical_fov_degrees = 0.01;
  view.lights[0] = scene::point_light("", {1000, 1, 0}, glm::vec3(1e20f));
  view.medium.sigma_s = glm::vec3(0.08f);
  view.medium.top = 0.0;
  view.size = {1, 1};
  const double expected = expected_radiance(view, k_infinity).r;
  const double radiance = static_cast<double>(Reference({}, view).exact().radiance[0].r);
  EXPECT_NEAR(radiance / expected, 1.0, 1e-6);
}

TEST(Layer, ThatReachesOverAllIsEndlessFog) {
  scene::View view = tests::clutter_view(16);
  const std::vector<glm::vec3> endless = Reference(tests::clutter(50), view).exact().radiance;
  view.medium.top = 1e6;
  const std::vector<glm::vec3> deep = Reference(tests::clutter(50), view).exact().radiance;
  for (std::size_t i = 0; i < endless.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(static_cast<double>(deep[i][channel]) / static_cast<double>(endless[i][channel]), 1.0,
                  1e-6);
  }
}

TEST(Layer, BelowEyeAndSightHoldsNoLight) {
  scene::View view = tests::clutter_view(8);
  view.camera.target = view.camera.eye + glm::dvec3(0, 3, -1);
  view.medium.top = -2.5;
  const Reference reference(tests::clutter(50), view);
  for (const AirlightImage& image :
       {reference.exact(), reference.sampled(64), reference.march(64, RayMode::packet)}) {
    for (const glm::vec3& radiance : image.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
    EXPECT_EQ(image.rays, 0u);
  }
}

TEST(Layer, RaysConvergeToTheTruth) {
  // A lamp above the fog, whose top cuts through the clutter.
  scene::View view = tests::clutter_view(24);
  view.lights[0].position = {0.3, 2.4, -0.4};
  view.lights[0].intensity = glm::vec3(5.0f);
  view.medium.sigma_s = glm::vec3(0.4f);
  view.medium.top = 0.7;
  const Reference reference(tests::clutter(150), view);
  const auto mean_difference = [truth = reference.exact()](const AirlightImage& image) {
    double sum = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < image.radiance.size(); ++i) {
      sum += std::abs(static_cast<double>(image.radiance[i].r - truth.radiance[i].r));
      whole += static_cast<double>(truth.radiance[i].r);
    }
    return sum / whole;
  };
  EXPECT_LT(mean_difference(reference.sampled(1024)), 1e-4);
  EXPECT_LT(mean_difference(reference.march(1024, RayMode::packet)), 2e-3);
  EXPECT_LT(mean_difference(reference.exact(4)), 1e-7);
}

}  // namespace
}  // namespace airlight::reference
