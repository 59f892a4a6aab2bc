#include "reference/light_texture.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "support/random.h"
#include "unit/reference/fixtures.h"

namespace airlight::reference {
namespace {

using std::numbers::pi;
using tests::one_pixel_view;

/// Texels of a few decades, alike in no direction.
std::shared_ptr<const scene::LightTexture> random_texture(glm::ivec2 size) {
  airlight::tests::Random random(3);
  std::vector<glm::vec3> texels;
  for (int i = 0; i < size.x * size.y; ++i) {
    texels.emplace_back(random.logarithmic(0.01, 2), random.uniform(), random.bits() % 2);
  }
  return std::make_shared<scene::LightTexture>("random", size, std::move(texels));
}

glm::dvec3 direction(double longitude, double latitude) {
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude)};
}

void expect_near(const glm::dvec3& value, const glm::dvec3& expected) {
  EXPECT_NEAR(glm::distance(value, expected), 0.0, 1e-12) << value.x << ", expected " << expected.x;
}

TEST(LightLookup, HasUpAtTheTopAndTheXAxisToTheLeftOfTheZAxis) {
  std::vector<glm::vec3> texels;
  for (int i = 0; i < 8; ++i) texels.emplace_back(static_cast<float>(i));
  const scene::LightTexture texture("", {4, 2}, std::move(texels));  // 0 1 2 3 above 4 5 6 7
  const LightLookup light(texture);
  expect_near(light.at(direction(pi / 4, pi / 4)), glm::dvec3(1));         // of +Z, to +X, up
  expect_near(light.at(direction(3 * pi / 4, pi / 4)), glm::dvec3(0));     // of +X, to −Z, up
  expect_near(light.at(direction(-pi / 4, pi / 4)), glm::dvec3(2));        // of +Z, to −X, up
  expect_near(light.at(direction(pi / 4, -pi / 4)), glm::dvec3(5));        // down
  expect_near(light.at(5.0 * direction(pi / 4, -pi / 4)), glm::dvec3(5));  // of any length
  expect_near(light.at({1, 0, 0}), glm::dvec3(2.5));                       // between 0, 1, 4, 5
  expect_near(light.at({0, 0, -1}), glm::dvec3(3.5));                      // around the back: 0, 3, 4, 7
  expect_near(light.at(direction(pi / 4, 0.499 * pi)), glm::dvec3(1));     // constant towards a pole
  expect_near(light.at(direction(pi / 4, -0.499 * pi)), glm::dvec3(5));
}

TEST(LightLookup, OfOneTexelIsConstant) {
  const scene::LightTexture texture("", {1, 1}, {{1, 2, 3}});
  airlight::tests::Random random(4);
  for (int i = 0; i < 100; ++i) expect_near(LightLookup(texture).at(random.direction()), {1, 2, 3});
}

/// The airlight of an endless view ray without shadow, integrated over the distance.
glm::dvec3 airlight_over_distance(const scene::View& view, const LightLookup& light) {
  const glm::dvec3 to_light = view.lights[0].position - view.camera.eye;
  const glm::dvec3 ray = glm::normalize(view.camera.target - view.camera.eye);
  glm::dvec3 radiance(0.0);
  for (int channel = 0; channel < 3; ++channel) {
    const auto sigma_s = static_cast<double>(view.medium.sigma_s[channel]);
    const double sigma_t = sigma_s + static_cast<double>(view.medium.sigma_a[channel]);
    const auto integrand = [&](double t) {
      const glm::dvec3 from_light = t * ray - to_light;
      const double r = glm::length(from_light);
      return sigma_s * std::exp(-sigma_t * (t + r)) * phase(view.medium, -glm::dot(from_light, ray) / r) *
             static_cast<double>(view.lights[0].intensity[channel]) / (r * r) * light.at(from_light)[channel];
    };
    // Where the texture is not smooth the rule is of low order: many short intervals.
    const double D = glm::length(to_light), end = 30 / sigma_t + 2 * D;
    const int intervals = 400;
    for (int i = 0; i < intervals; ++i) {
      const auto place = [&](int n) { return end * std::pow(static_cast<double>(n) / intervals, 3); };
      radiance[channel] += tests::integrate(integrand, place(i), place(i + 1), 1e-12);
    }
  }
  return radiance;
}

TEST(TexturedLight, InEmptyFogMatchesTheIntegralOverDistance) {
  for (glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2, 1), glm::ivec2(5, 3), glm::ivec2(32, 16)}) {
    for (glm::dvec3 target : {glm::dvec3(0.1, 0, 1), glm::dvec3(0.3, 0.5, -0.8), glm::dvec3(1, -0.2, 0.1)}) {
      scene::View view = one_pixel_view(3.0, 1.0);
      view.camera.target = target;
      view.lights[0].texture = random_texture(size);
      view.medium = {.sigma_s = {0.1f, 0.3f, 0.6f},
                     .sigma_a = {0.0f, 0.1f, 0.0f},
                     .phase = scene::PhaseFunction::hoffman_preetham,
                     .g = 0.6f};
      const glm::dvec3 expected = airlight_over_distance(view, LightLookup(*view.lights[0].texture));
      const AirlightImage image = Reference({}, view).exact();
      const glm::vec3 march = Reference({}, view).march(8192, RayMode::packet).radiance[0];
      for (int channel = 0; channel < 3; ++channel) {
        const auto value = static_cast<double>(image.radiance[0][channel]);
        EXPECT_NEAR(value, expected[channel], 2e-6 * expected[channel]) << size.x << " " << target.x;
        // The midpoint rule over kinks.
        EXPECT_NEAR(static_cast<double>(march[channel]), expected[channel], 2e-5 * expected[channel])
            << size.x << " " << target.x;
      }
    }
  }
}

TEST(TexturedLight, OverAPoleMatchesTheIntegralOverDistance) {
  // The light right above the view ray, or beside it by next to nothing: the azimuth turns at once.
  for (double aside : {0.0, 1e-9, 1e-4, 0.05}) {
    scene::View view = one_pixel_view(3.0, 1.0);
    view.lights[0].position = {aside, 2, 2};
    view.lights[0].texture = random_texture({6, 3});
    const glm::dvec3 expected = airlight_over_distance(view, LightLookup(*view.lights[0].texture));
    const glm::vec3 radiance = Reference({}, view).exact().radiance[0];
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(static_cast<double>(radiance[channel]), expected[channel], 4e-6 * expected[channel])
          << aside << " " << channel;
    }
  }
}

TEST(TexturedLight, OfOneColourScalesTheIntensity) {
  const scene::Geometry geometry = tests::clutter(40);
  scene::View view = tests::clutter_view(8);
  scene::View scaled = view;
  const glm::vec3 colour(0.5f, 2.0f, 0.0f);
  scaled.lights[0].intensity *= colour;
  view.lights[0].texture =
      std::make_shared<scene::LightTexture>("", glm::ivec2(7, 4), std::vector<glm::vec3>(28, colour));
  const Reference textured(geometry, view), plain(geometry, scaled);
  const AirlightImage image = textured.sampled(64), expected = plain.sampled(64);
  EXPECT_EQ(image.rays, expected.rays);
  EXPECT_NEAR(image.self_error, expected.self_error, 1e-6);
  const AirlightImage march = textured.march(64, RayMode::packet),
                      expected_march = plain.march(64, RayMode::packet);
  for (std::size_t i = 0; i < image.radiance.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(image.radiance[i][channel], expected.radiance[i][channel],
                  2e-6f * expected.radiance[i][channel]);
      EXPECT_NEAR(march.radiance[i][channel], expected_march.radiance[i][channel],
                  2e-6f * expected_march.radiance[i][channel]);
    }
  }
}

}  // namespace
}  // namespace airlight::reference
