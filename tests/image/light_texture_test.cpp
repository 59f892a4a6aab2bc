#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"
#include "scene/light_texture.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/view_rays.h"

/// A light textured by direction, in surfaces and airlight.
namespace airlight {
namespace {

using scene::LightTexture;

constexpr media::VsvIntegral k_of_all_light[] = {media::VsvIntegral::quadrature, media::VsvIntegral::riemann};

tests::VsvSettings by(media::VsvIntegral integral) {
  return {.resolution = {512, 2048, 512}, .integral = integral, .shadow_map = 2048, .surface_shadows = true};
}

std::shared_ptr<const LightTexture> texture_of(glm::ivec2 size,
                                               const std::function<glm::vec3(int, int)>& colour) {
  std::vector<glm::vec3> texels;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) texels.push_back(colour(x, y));
  }
  return std::make_shared<LightTexture>("test", size, std::move(texels));
}

/// Black where x < 0, with one texel between: columns left of the middle look towards +X.
std::shared_ptr<const LightTexture> half_black() {
  return texture_of({64, 32}, [](int x, int) { return glm::vec3(x < 32 ? 1.0f : 0.0f); });
}

TEST(TexturedLight, OfOneColourScalesSurfacesAndAirlight) {
  const scene::Scene& scene = tests::builtin("cornell");
  scene::View view = tests::view_of(scene, {48, 48});
  scene::View scaled = view;
  const glm::vec3 colour(0.5f, 2.0f, 0.0f);
  scaled.lights[0].intensity *= colour;
  view.lights[0].texture = texture_of({7, 4}, [&](int, int) { return colour; });
  for (const media::VsvIntegral integral : k_of_all_light) {
    const frame::FrameImages image = tests::render_vsv(scene.geometry, view, by(integral));
    const frame::FrameImages expected = tests::render_vsv(scene.geometry, scaled, by(integral));
    // Quadrature takes the light of a run from a table, a difference of two sums: up to 1e-7 of what all of
    // half a turn sends.
    const float rounding = integral == media::VsvIntegral::riemann ? 2e-6f : 1e-4f;
    for (std::size_t i = 0; i < image.radiance.size(); ++i) {
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(image.airlight[i][channel], expected.airlight[i][channel],
                    rounding * expected.airlight[i][channel]);
        EXPECT_NEAR(image.radiance[i][channel], expected.radiance[i][channel],
                    rounding * expected.radiance[i][channel]);
      }
    }
  }
}

/// A closed room of 4 m around the light.
scene::Geometry room() {
  scene::Geometry geometry;
  tests::add_box(geometry, glm::vec3(-2), glm::vec3(2));
  return geometry;
}

TEST(TexturedLight, WithOneBrightSpotLightsTheWallItPointsTo) {
  struct Spot {
    glm::ivec2 texel;  // of 8×4
    glm::dvec3 towards;
  };
  // Columns 0–7 look, from the back, past +X, +Z and −X to the back again.
  const Spot spots[] = {{{1, 1}, {1, 0.4, -0.4}},  {{2, 1}, {1, 0.4, 0.4}},   {{3, 2}, {0.4, -0.4, 1}},
                        {{5, 2}, {-1, -0.4, 0.4}}, {{7, 1}, {-0.4, 0.4, -1}}, {{0, 1}, {0.4, 0.4, -1}}};
  const scene::Geometry geometry = room();
  frame::Frame frame(tests::gpu_context(), geometry, 64);
  frame::NoShadow no_shadow;
  frame::NoAirlight no_airlight;
  gpu::StageTimer off(nullptr);
  for (const Spot& spot : spots) {
    scene::View view;
    view.lights[0].position = {0, 0, 0};
    view.lights[0].texture = texture_of(
        {8, 4}, [&](int x, int y) { return glm::vec3(spot.texel == glm::ivec2(x, y) ? 1.0f : 0.0f); });
    view.size = {1, 1};
    view.camera.vertical_fov_degrees = 1;
    const auto brightness_towards = [&](glm::dvec3 direction) {
      view.camera.eye = -0.05 * direction;  // behind the light, which looks the same way
      view.camera.target = direction;
      frame.render(view, no_shadow, no_airlight, off);
      return frame.read().radiance[0].x;
    };
    const float brightness = brightness_towards(spot.towards);
    EXPECT_GT(brightness, 0.01f) << spot.texel.x;
    for (const Spot& other : spots) {
      if (other.texel == spot.texel) continue;
      EXPECT_LT(brightness_towards(other.towards), 0.5f * brightness) << spot.texel.x << " " << other.texel.x;
    }
    EXPECT_EQ(brightness_towards(-spot.towards), 0.0f) << spot.texel.x;
  }
}

class TexturedLightBy : public testing::TestWithParam<media::VsvIntegral> {};
INSTANTIATE_TEST_SUITE_P(Integrals, TexturedLightBy, testing::ValuesIn(k_of_all_light),
                         [](const auto& test) { return tests::name_of(test.param); });

TEST_P(TexturedLightBy, HalfBlackAgreesWithTheReference) {
  const scene::Scene& scene = tests::builtin("cornell");
  scene::View view = tests::view_of(scene, {64, 64});
  const frame::FrameImages plain = tests::render_vsv(scene.geometry, view, by(media::VsvIntegral::riemann));
  view.lights[0].texture = half_black();
  const tests::Truth truth = tests::trace(scene.geometry, view);
  const frame::FrameImages images = tests::render_vsv(scene.geometry, view, by(GetParam()));
  // The grid's error as without a texture, and a sum over cells across the edge between light and dark, a
  // texel wide.
  const auto error = tests::error_of(images, truth);
  EXPECT_LT(error.rrmse, 5e-3);
  EXPECT_LT(std::abs(error.bias), 2e-3);
  RecordProperty("rrmse", std::to_string(error.rrmse));

  // Surfaces: as without a texture where the light ray goes to +X, black where to −X.
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  int bright = 0, dark = 0;
  for (std::size_t i = 0; i < images.radiance.size(); ++i) {
    if (images.distance[i] == 0.0f) continue;
    const glm::dvec3 ray = tests::pixel_ray(camera, view.size, i);
    const glm::dvec3 d = camera.eye + static_cast<double>(images.distance[i]) * ray - view.lights[0].position;
    const double longitude = std::atan2(d.x, d.z), edge = 2 * std::numbers::pi / 64;
    const bool is_near_an_edge = std::abs(longitude) < edge || std::abs(longitude) > std::numbers::pi - edge;
    if (is_near_an_edge) continue;
    const glm::vec3 surface = images.radiance[i] - images.airlight[i];
    const glm::vec3 expected = d.x > 0 ? plain.radiance[i] - plain.airlight[i] : glm::vec3(0.0f);
    // A difference of two images.
    EXPECT_NEAR(glm::distance(surface, expected), 0.0f, 1e-6f * (1 + glm::length(plain.radiance[i])));
    if (glm::length(plain.radiance[i] - plain.airlight[i]) > 1e-3f) ++(d.x > 0 ? bright : dark);
  }
  EXPECT_GT(bright, 100);
  EXPECT_GT(dark, 100);
}

TEST_P(TexturedLightBy, InEmptyFogAgreesWithTheReferenceFromEverySide) {
  scene::View view = tests::view_of(tests::builtin("empty"), {24, 24});
  view.medium.sigma_s = {0.1f, 0.3f, 0.5f};
  view.lights[0].texture = texture_of({16, 8}, [](int x, int y) {
    return glm::vec3((x + y) % 2 == 0 ? 1.0f : 0.1f, static_cast<float>(x) / 16, static_cast<float>(y) / 8);
  });
  for (glm::dvec3 offset : {glm::dvec3(0, 0, 0), glm::dvec3(0.5, 2, 0.1), glm::dvec3(-1, -3, 9)}) {
    view.lights[0].position += offset;
    const auto expected = reference::Reference({}, view).exact().radiance;
    const auto error = tests::error_of(tests::render_vsv({}, view, by(GetParam())).airlight, expected);
    // A sum over 512 cells of a texture that is not smooth; or panels within which the fog is a straight
    // line.
    EXPECT_LT(error.max, 5e-3);
    EXPECT_LT(std::abs(error.bias), 1e-3);
    RecordProperty("max", std::to_string(error.max));
  }
}

TEST(TexturedLight, ComesAndGoesFromFrameToFrame) {
  const scene::Scene& scene = tests::builtin("cornell");
  const scene::View plain = tests::view_of(scene, {16, 16});
  scene::View textured = plain;
  textured.lights[0].texture = half_black();
  frame::Frame frame(tests::gpu_context(), scene.geometry, 256);
  media::Vsv vsv(tests::gpu_context(), {.volume = {.resolution = {64, 128, 128}}});
  frame::NoShadow no_shadow;
  gpu::StageTimer off(nullptr);
  const auto radiance = [&](const scene::View& view) {
    frame.render(view, no_shadow, vsv, off);
    return frame.read().radiance;
  };
  const auto first = radiance(plain), second = radiance(textured);
  EXPECT_NE(first, second);
  EXPECT_EQ(radiance(plain), first);
  EXPECT_EQ(radiance(textured), second);
}

TEST(TexturedLight, IsRefusedByIntegralsThatLookUpATableOfAlphaAndPhi) {
  scene::View view = tests::view_of(tests::builtin("empty"), {8, 8});
  view.lights[0].texture = half_black();
  for (media::VsvIntegral integral : {media::VsvIntegral::table, media::VsvIntegral::factored}) {
    const auto refusal = media::VsvOptions{.integral = integral}.refusal(view);
    ASSERT_TRUE(refusal);
    EXPECT_THAT(refusal->remedy, testing::HasSubstr("integral=quadrature"));
  }
  for (const media::VsvIntegral integral : k_of_all_light)
    EXPECT_FALSE(media::VsvOptions{.integral = integral}.refusal(view));
  EXPECT_EQ(media::VsvOptions{}.used_integral(view), media::VsvIntegral::quadrature);
}

}  // namespace
}  // namespace airlight
