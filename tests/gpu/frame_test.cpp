#include "frame/frame.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "frame/none.h"
#include "media/vsv.h"
#include "scene/light_texture.h"
#include "support/gpu_context.h"
#include "support/scenes.h"
#include "support/view_rays.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace airlight::frame {
namespace {

using surface_shadows::ShadowMapLookup;
using tests::builtin;
using tests::gpu_context;
using tests::view_of;

media::Vsv small_vsv(media::VsvIntegral integral = media::VsvIntegral::table) {
  return {gpu_context(), {.integral = integral, .volume = {.resolution = {64, 128, 128}}}};
}

FrameImages render(Frame& frame, const scene::View& view, SurfaceShadow& shadow, Airlight& airlight) {
  gpu::StageTimer off(nullptr);
  frame.render(view, shadow, airlight, off);
  return frame.read();
}

void expect_near(const std::vector<glm::vec3>& image, const std::vector<glm::vec3>& expected,
                 double relative) {
  ASSERT_EQ(image.size(), expected.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const auto value = static_cast<double>(expected[i][channel]);
      ASSERT_NEAR(static_cast<double>(image[i][channel]), value, relative * value) << "pixel " << i;
    }
  }
}

/// Which, and how many.
template <class Value>
std::string pixels_that_differ(const std::vector<Value>& image, const std::vector<Value>& expected) {
  std::string pixels;
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::max(image.size(), expected.size()); ++i)
    if (i >= image.size() || i >= expected.size() || image[i] != expected[i])
      if (++count <= 10) pixels += fmt::format("{} ", i);
  return count == 0 ? "" : fmt::format("{} of {}: {}", count, image.size(), pixels);
}

std::shared_ptr<const scene::LightTexture> two_colours() {
  return std::make_shared<scene::LightTexture>(
      "t", glm::ivec2(2, 1), std::vector<glm::vec3>{{1.0f, 0.2f, 0.1f}, {0.0f, 1.0f, 0.5f}});
}

/// Cornell with two more lamps.
scene::View three_lamps() {
  scene::View view = view_of(builtin("cornell"), {24, 20});
  view.lights.push_back(scene::point_light("second", {0.5, 1.4, 0.3}, {0.2f, 0.3f, 0.9f}));
  view.lights.push_back(scene::point_light("third", {-0.5, 1.2, 1.5}, {0.5f, 0.1f, 0.1f}));
  return view;
}

/// A frame with three lights has to be the sum of three with one each.
void expect_sum_of_lights(const media::VsvOptions& options, const scene::View& view) {
  const scene::Scene& scene = builtin("cornell");
  Frame frame(gpu_context(), scene.geometry, 256);
  ShadowMapLookup shadow;
  media::Vsv vsv(gpu_context(), options);
  const FrameImages all = render(frame, view, shadow, vsv);
  ASSERT_EQ(all.visibility.size(), 3u);

  std::vector<glm::vec3> radiance(all.radiance.size(), glm::vec3(0.0f)), airlight = radiance;
  for (std::size_t light = 0; light < view.lights.size(); ++light) {
    scene::View alone = view;
    alone.lights = {view.lights[light]};
    media::Vsv fresh(gpu_context(), options);  // it remembers no other light
    const FrameImages one = render(frame, alone, shadow, fresh);
    EXPECT_TRUE(std::any_of(one.airlight.begin(), one.airlight.end(),
                            [](const glm::vec3& value) { return value.g > 0.0f; }))
        << "light " << light << " is inside of something";
    for (std::size_t i = 0; i < radiance.size(); ++i) {
      radiance[i] += one.radiance[i];
      airlight[i] += one.airlight[i];
    }
    EXPECT_EQ(pixels_that_differ(all.visibility[light], one.visibility[0]), "") << "light " << light;
    EXPECT_EQ(pixels_that_differ(all.airlight_of_light[light], one.airlight), "") << "light " << light;
    EXPECT_EQ(all.lights[light], view.lights[light].name);
    EXPECT_TRUE(one.airlight_of_light.empty());
  }
  expect_near(all.radiance, radiance, 1e-6);
  expect_near(all.airlight, airlight, 1e-6);
}

TEST(Frame, AddsUpItsLights) {
  expect_sum_of_lights({.volume = {.resolution = {64, 128, 128}}}, three_lamps());
}

TEST(Frame, AddsUpItsLightsOfAConservativeGrid) {
  expect_sum_of_lights(
      {.volume = {.resolution = {64, 128, 128}, .populate = epipolar::Populate::conservative}},
      three_lamps());
}

TEST(Frame, AddsUpTexturedLightsAndOthers) {
  scene::View view = three_lamps();
  view.lights[1].texture = two_colours();
  view.lights[2].texture = two_colours();
  expect_sum_of_lights({.integral = media::VsvIntegral::riemann, .volume = {.resolution = {64, 128, 128}}},
                       view);
}

TEST(Frame, AddsUpASunAndLamps) {
  scene::View view = three_lamps();
  view.lights[1] = scene::sun("sun", {0.2, 0.5, 1}, {2.0f, 1.5f, 1.0f});
  view.medium.sigma_a = {0.0f, 0.1f, 0.2f};
  expect_sum_of_lights({.volume = {.resolution = {64, 128, 128}}}, view);
  view.medium.top = 3.0;
  expect_sum_of_lights({.volume = {.resolution = {64, 128, 128}}}, view);
}

TEST(Frame, AddsUpLightsThatNeedTablesOfTheirOwn) {
  // The distance to the second makes its integrand rough; its table has more rows.
  scene::View view = three_lamps();
  view.medium.sigma_a = glm::vec3(0.9f);
  view.lights[1].position = {0.3, 1.2, -3.9};
  expect_sum_of_lights({.volume = {.resolution = {64, 128, 128}}}, view);
}

TEST(Frame, TimesTheStagesOfEachLight) {
  const scene::View view = three_lamps();
  Frame frame(gpu_context(), builtin("cornell").geometry, 64);
  ShadowMapLookup shadow;
  media::Vsv vsv = small_vsv();
  gpu::StageTimer timer(&gpu_context());
  frame.render(view, shadow, vsv, timer);
  std::map<std::string, double> sums;
  for (std::size_t light = 0; light < 3; ++light) {
    const auto of_light = timer.milliseconds(light);
    EXPECT_TRUE(of_light.contains("integrate") && of_light.contains("composite")) << light;
    EXPECT_FALSE(of_light.contains("surfaces")) << light;
    for (const auto& [stage, ms] : of_light) sums[stage] += ms;
  }
  sums["surfaces"] = timer.milliseconds().at("surfaces");
  EXPECT_EQ(sums.size(), timer.milliseconds().size());
  for (const auto& [stage, ms] : timer.milliseconds())
    EXPECT_NEAR(sums[stage], ms, 1e-9 + 1e-9 * ms) << stage;
}

/// Sees every light.
class ThoroughAirlight : public NoAirlight {
 public:
  void integrate(const FrameInputs& inputs, const gpu::Texture& radiance) override {
    ++calls;
    NoAirlight::integrate(inputs, radiance);
  }
  bool sees_every_light() const override { return is_thorough; }
  int calls = 0;
  bool is_thorough = false;
};

TEST(Frame, SkipsLightsThatCannotReachTheViewAndShowsTheSame) {
  const scene::Scene& scene = builtin("cornell");
  const scene::View three = three_lamps();
  ShadowMapLookup shadow;
  media::Vsv vsv = small_vsv();
  Frame frame(gpu_context(), scene.geometry, 64);
  for (const std::size_t skipped : {0u, 1u, 2u}) {
    scene::View view = three;
    view.lights[skipped].position = {0, 0, 1e4};
    scene::View others = three;
    others.lights.erase(others.lights.begin() + static_cast<std::ptrdiff_t>(skipped));
    const FrameImages images = render(frame, view, shadow, vsv);
    for (std::size_t light = 0; light < 3; ++light) EXPECT_EQ(images.is_skipped[light], light == skipped);
    EXPECT_EQ(images.airlight_of_light[skipped],
              std::vector<glm::vec3>(images.radiance.size(), glm::vec3(0.0f)));
    EXPECT_EQ(images.visibility[skipped], std::vector<float>(images.radiance.size(), 0.0f));
    const FrameImages expected = render(frame, others, shadow, vsv);
    EXPECT_EQ(images.radiance, expected.radiance);
    EXPECT_EQ(images.airlight, expected.airlight);
  }

  scene::View view = three;
  for (scene::Light& light : view.lights) light.position = {0, 0, 1e4};
  const FrameImages black = render(frame, view, shadow, vsv);
  EXPECT_EQ(black.radiance, std::vector<glm::vec3>(black.radiance.size(), glm::vec3(0.0f)));
  EXPECT_EQ(black.airlight, black.radiance);
  view.lights.resize(1);
  EXPECT_EQ(render(frame, view, shadow, vsv).radiance, black.radiance);

  ThoroughAirlight airlight;
  render(frame, view, shadow, airlight);
  EXPECT_EQ(airlight.calls, 0);
  airlight.is_thorough = true;
  EXPECT_FALSE(render(frame, view, shadow, airlight).is_skipped[0]);
  EXPECT_EQ(airlight.calls, 1);
}

/// Lets an amount through that is the same everywhere.
class Filter : public SurfaceShadow {
 public:
  Filter(gpu::Format format, glm::vec3 part) : format_(format), part_(part) {}
  gpu::Format visibility_format(const frame::SceneBuffers&) const override { return format_; }
  void query(const FrameInputs&, const gpu::Texture& visibility) override {
    const auto pixels = static_cast<std::size_t>(visibility.size().x * visibility.size().y);
    if (format_ == gpu::Format::r32f) {
      visibility.write(std::vector<float>(pixels, part_.r).data());
    } else {
      visibility.write(std::vector<glm::vec4>(pixels, glm::vec4(part_, 0.0f)).data());
    }
  }

 private:
  gpu::Format format_;
  glm::vec3 part_;
};

TEST(Frame, ColoursTheLightThatOccludersLetThrough) {
  const scene::Scene& scene = builtin("cornell");
  const scene::View view = view_of(scene, {16, 12});
  Frame frame(gpu_context(), scene.geometry, 64);
  NoShadow no_shadow;
  NoAirlight no_airlight;
  const std::vector<glm::vec3> lit = render(frame, view, no_shadow, no_airlight).radiance;
  const auto through = [&](gpu::Format format, glm::vec3 part) {
    Filter filter(format, part);
    return render(frame, view, filter, no_airlight);
  };
  std::vector<glm::vec3> expected;
  for (const glm::vec3& radiance : lit) expected.push_back(radiance * glm::vec3(0.5f, 0.25f, 0.0f));
  FrameImages coloured = through(gpu::Format::rgba32f, {0.5f, 0.25f, 0.0f});
  // What is let through from behind glows: transmission_test.cpp.
  for (std::size_t i = 0; i < lit.size(); ++i)
    if (lit[i] == glm::vec3(0.0f)) coloured.radiance[i] = lit[i];
  expect_near(coloured.radiance, expected, 1e-6);
  EXPECT_EQ(coloured.transmittance[0][100], glm::vec3(0.5f, 0.25f, 0.0f));
  EXPECT_FLOAT_EQ(coloured.visibility[0][100], 0.25f) << "the mean";
  for (std::size_t i = 0; i < lit.size(); ++i) expected[i] = 0.5f * lit[i];
  expect_near(through(gpu::Format::r32f, glm::vec3(0.5f)).radiance, expected, 1e-6);
}

TEST(Frame, RemembersNothingOfTheFramesBefore) {
  const scene::Scene& scene = builtin("cornell");
  Frame kept(gpu_context(), scene.geometry, 256);
  ShadowMapLookup shadow;
  media::Vsv kept_vsv = small_vsv(media::VsvIntegral::riemann);
  const std::vector<std::pair<const char*, std::function<void(scene::View&)>>> changes = {
      {"nothing", [](scene::View&) {}},
      {"camera", [](scene::View& view) { view.camera.eye += glm::dvec3(0.3, -0.1, -0.5); }},
      {"light",
       [](scene::View& view) {
         view.lights[0].position = {0.4, 0.9, 0.7};
       }},
      {"second light",
       [](scene::View& view) {
         view.lights.push_back(scene::point_light("", {-0.6, 0.3, 0.9}, {0.1f, 0.2f, 0.9f}));
       }},
      {"texture", [](scene::View& view) { view.lights[1].texture = two_colours(); }},
      {"size",
       [](scene::View& view) {
         view.size = {20, 33};
       }},
      {"phase function",
       [](scene::View& view) {
         view.medium.phase = scene::PhaseFunction::henyey_greenstein;
         view.medium.g = 0.6f;
       }},
      {"medium",
       [](scene::View& view) {
         view.medium.sigma_a = {0.0f, 0.1f, 0.3f};
       }},
      {"lights", [](scene::View& view) { view.lights.pop_back(); }},
      {"size again",
       [](scene::View& view) {
         view.size = {24, 24};
       }},
  };
  scene::View view = view_of(scene, {24, 24});
  for (const auto& [what, change] : changes) {
    change(view);
    Frame fresh(gpu_context(), scene.geometry, 256);
    media::Vsv vsv = small_vsv(media::VsvIntegral::riemann);
    const FrameImages expected = render(fresh, view, shadow, vsv);
    const FrameImages images = render(kept, view, shadow, kept_vsv);
    EXPECT_EQ(images.radiance, expected.radiance) << what;
    EXPECT_EQ(images.airlight, expected.airlight) << what;
    EXPECT_EQ(images.airlight_of_light, expected.airlight_of_light) << what;
    EXPECT_EQ(images.visibility, expected.visibility) << what;
    EXPECT_EQ(images.distance, expected.distance) << what;
  }
}

/// Compares a floor that the light shines on, without airlight, with its closed form.
/// @param share      of the light's intensity at a point relative to it [m]
/// @param is_unsure  whether rounding may decide over that point
void expect_shaded_floor(const scene::Light& light, const std::function<double(glm::dvec3)>& share,
                         const std::function<bool(glm::dvec3)>& is_unsure) {
  scene::Geometry floor;
  tests::add_quad(floor, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
  floor.materials[0].albedo = {0.8f, 0.5f, 0.2f};
  scene::View view;
  view.camera.eye = {0.5, 2, 3};
  view.camera.target = {0, 0, 0};
  view.lights = {light};
  view.medium.sigma_s = {0.1f, 0.2f, 0.3f};
  view.medium.sigma_a = {0.05f, 0.0f, 0.1f};
  view.size = {16, 16};
  Frame frame(gpu_context(), floor, 64);
  NoShadow no_shadow;
  NoAirlight no_airlight;
  const FrameImages images = render(frame, view, no_shadow, no_airlight);

  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  int seen = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const glm::dvec3 ray = tests::pixel_ray(camera, view.size, x, y);
      const double d = -camera.eye.y / ray.y;
      if (d <= 0 || d > 40) continue;
      ++seen;
      const glm::dvec3 to_light = light.position - (camera.eye + d * ray);
      if (is_unsure(-to_light)) continue;
      const double r = glm::length(to_light);
      for (int channel = 0; channel < 3; ++channel) {
        const double sigma_t =
            static_cast<double>(view.medium.sigma_s[channel] + view.medium.sigma_a[channel]);
        const double expected = static_cast<double>(floor.materials[0].albedo[channel]) / std::numbers::pi *
                                static_cast<double>(light.intensity[channel]) * (to_light.y / r) / (r * r) *
                                std::exp(-sigma_t * (r + d));
        // Single precision, the exponential's error growing with its exponent.
        EXPECT_NEAR(static_cast<double>(images.radiance[static_cast<std::size_t>(16 * y + x)][channel]),
                    share(-to_light) * expected, 1e-5 * expected);
      }
    }
  }
  EXPECT_GT(seen, 100);
}

/// A floor under a lamp that gives no light.
FrameImages floor_in_surroundings(const scene::Surroundings& surroundings, const scene::Medium& medium,
                                  const std::function<void(glm::dvec3 ray, glm::vec3 radiance)>& look) {
  scene::Geometry floor;
  tests::add_quad(floor, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
  floor.materials[0].albedo = {0.8f, 0.5f, 0.2f};
  scene::View view;
  view.camera.eye = {0.5, 2, 3};
  view.camera.target = {0, 2, 0};
  view.lights = {scene::point_light("", {1, 1.5, -1}, glm::vec3(0))};
  view.medium = medium;
  view.size = {16, 16};
  view.surroundings = surroundings;
  Frame frame(gpu_context(), floor, 64);
  NoShadow no_shadow;
  NoAirlight no_airlight;
  FrameImages images = render(frame, view, no_shadow, no_airlight);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  for (std::size_t i = 0; i < images.radiance.size(); ++i)
    look(tests::pixel_ray(camera, view.size, i), images.radiance[i]);
  return images;
}

TEST(Frame, SurfacesReflectWhatSurroundsThemAndFogLiesBefore) {
  const scene::Medium medium{.sigma_s = {0.1f, 0.2f, 0.3f}, .sigma_a = {0.05f, 0.0f, 0.1f}};
  int seen = 0;
  floor_in_surroundings({.ambient = {1, 2, 3}}, medium, [&](glm::dvec3 ray, glm::vec3 radiance) {
    if (ray.y >= 0.0) {
      EXPECT_EQ(radiance, glm::vec3(0));
    }
    if (ray.y > -0.06) return;  // beyond the floor's end
    ++seen;
    const glm::dvec3 expected = glm::dvec3(1, 2, 3) * glm::dvec3(0.8, 0.5, 0.2) *
                                glm::exp(-glm::dvec3(0.15, 0.2, 0.4) * (2.0 / -ray.y));
    // Single precision, the exponential's error growing with its exponent.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(static_cast<double>(radiance[i]), expected[i], 1e-5 * expected[i]);
  });
  EXPECT_GT(seen, 50);
}

TEST(Frame, TheBackgroundIsSeenThroughTheFogsLayer) {
  const scene::Medium medium{.sigma_s = {0.1f, 0.2f, 0.3f}, .top = 5.0};
  int seen = 0;
  floor_in_surroundings({.background = {1, 2, 3}}, medium, [&](glm::dvec3 ray, glm::vec3 radiance) {
    if (ray.y < -0.06) {
      EXPECT_EQ(radiance, glm::vec3(0));
    }
    if (ray.y < 0.0) return;
    ++seen;
    const glm::dvec3 expected = glm::dvec3(1, 2, 3) * glm::exp(-glm::dvec3(0.1, 0.2, 0.3) * (3.0 / ray.y));
    // The same; and rays that all but keep their height.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(static_cast<double>(radiance[i]), expected[i], 1e-4 * expected[i] + 1e-30);
  });
  EXPECT_GT(seen, 50);
}

TEST(Frame, FogWithoutAnEndHidesTheBackgroundAndNoFogDoesNot) {
  floor_in_surroundings({.background = {1, 2, 3}}, {.sigma_s = {0.1f, 0.0f, 0.1f}},
                        [&](glm::dvec3 ray, glm::vec3 radiance) {
                          if (ray.y >= 0.0) {
                            EXPECT_EQ(radiance, glm::vec3(0, 2, 0));
                          }
                        });
}

TEST(Frame, SurroundingsAreNoAirlight) {
  const auto nothing = [](glm::dvec3, glm::vec3) {};
  for (const glm::vec3& airlight :
       floor_in_surroundings({.ambient = {1, 2, 3}, .background = {1, 2, 3}}, {}, nothing).airlight)
    EXPECT_EQ(airlight, glm::vec3(0));
}

const scene::Light k_lamp = scene::point_light("", {1, 1.5, -1}, {3, 2, 1});

TEST(Frame, ShadesALambertSurfaceByItsClosedForm) {
  expect_shaded_floor(
      k_lamp, [](glm::dvec3) { return 1.0; }, [](glm::dvec3) { return false; });
}

TEST(Frame, ShadesASurfaceByTheLightsConeAndRange) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(-1, -1.5, 1));
  for (double inner : {0.3, 0.6}) {
    scene::Light spot = k_lamp;
    spot.cone = {.axis = axis, .inner = inner, .outer = 0.6};
    spot.range = 3.0;
    int dark = 0, lit = 0;
    const auto cosine = [&](glm::dvec3 point) { return glm::dot(axis, glm::normalize(point)); };
    expect_shaded_floor(
        spot,
        [&](glm::dvec3 point) {
          const double inside = cosine(point) - std::cos(0.6), width = std::cos(inner) - std::cos(0.6);
          const double ramp =
              inner == 0.6 ? (inside >= 0.0 ? 1.0 : 0.0) : std::clamp(inside / width, 0.0, 1.0);
          const double share = ramp * ramp * std::max(1.0 - std::pow(glm::length(point) / 3.0, 4.0), 0.0);
          ++(share > 0.0 ? lit : dark);
          return share;
        },
        [&](glm::dvec3 point) { return inner == 0.6 && std::abs(cosine(point) - std::cos(0.6)) < 1e-5; });
    EXPECT_GT(lit, 50);
    EXPECT_GT(dark, 50);
  }
}

TEST(Frame, DrawsAShadowMapOnlyForWhoAsks) {
  const scene::Scene& scene = builtin("cornell");
  const scene::View view = view_of(scene, {8, 8});
  Frame frame(gpu_context(), scene.geometry, 64);
  NoShadow no_shadow;
  NoAirlight no_airlight;
  ShadowMapLookup lookup;
  const auto has_shadow_map = [&](SurfaceShadow& shadow) {
    gpu::StageTimer timer(&gpu_context());
    frame.render(view, shadow, no_airlight, timer);
    EXPECT_EQ(timer.milliseconds().contains("shadow_map"), frame.bytes().contains("shadow_map"));
    return frame.bytes().contains("shadow_map");
  };
  EXPECT_FALSE(has_shadow_map(no_shadow));
  EXPECT_TRUE(has_shadow_map(lookup));
  EXPECT_EQ(frame.bytes().at("shadow_map"), 6 * 64 * 64 * 4);
  EXPECT_FALSE(has_shadow_map(no_shadow)) << "it is there, but this frame does not use it";
}

}  // namespace
}  // namespace airlight::frame
