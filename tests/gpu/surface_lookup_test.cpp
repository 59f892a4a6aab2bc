#include "epipolar/surface_lookup.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "frame/frame.h"
#include "frame/none.h"
#include "support/gpu_context.h"
#include "support/scenes.h"
#include "support/view_rays.h"

namespace airlight::epipolar {
namespace {

using tests::builtin;
using tests::view_of;

/// All angles, so that a cell's width follows from the count.
VolumeOptions settings_of(Populate populate) {
  return {.resolution = {512, 1024, 512}, .populate = populate, .ranges = Ranges::full};
}

/// What a pixel sees, and what the look-up says about it.
struct Seen {
  glm::dvec3 point;
  bool is_lit;
};

std::vector<Seen> look(const scene::Geometry& geometry, const scene::View& view,
                       const VolumeOptions& settings, int shadow_map_size = 2048) {
  frame::Frame frame(tests::gpu_context(), geometry, shadow_map_size);
  SurfaceLookup lookup(tests::gpu_context(), settings);
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(nullptr);
  frame.render(view, lookup, no_airlight, timer);
  const frame::FrameImages images = frame.read();
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < images.distance.size(); ++i) {
    if (images.distance[i] == 0.0f) continue;
    const glm::dvec3 ray = tests::pixel_ray(camera, view.size, i);
    seen.push_back(
        {camera.eye + static_cast<double>(images.distance[i]) * ray, images.visibility[0][i] == 1.0f});
  }
  return seen;
}

/// An occluder above a floor, with the shadow it casts in closed form.
struct Shadow {
  const char* scene;
  double floor;  ///< y [m]
  scene::Camera camera;
  std::function<bool(glm::dvec3 light, glm::dvec3 point)> is_lit;
};

const Shadow k_half_space = {
    "half-space",
    -2.5,
    {"", {1.5, -1.0, 7.0}, {-0.6, -2.5, 0.0}, {0, 1, 0}, 50.0},
    [](glm::dvec3, glm::dvec3 point) { return point.x > 0; },
};
const Shadow k_sphere = {
    "sphere",
    -2.0,
    {"", {2.0, 2.0, 5.0}, {0.0, -1.0, 0.0}, {0, 1, 0}, 60.0},
    [](glm::dvec3 light, glm::dvec3 point) {
      const glm::dvec3 to_point = point - light;
      const double nearest = -glm::dot(light, to_point) / glm::dot(to_point, to_point);
      return nearest <= 0 || nearest >= 1 || glm::length(light + nearest * to_point) > 1;
    },
};

class SurfaceLookupOn : public testing::TestWithParam<std::tuple<Populate, const Shadow*>> {};

TEST_P(SurfaceLookupOn, AFloorIsExactToOneCell) {
  const auto& [populate, shadow] = GetParam();
  const scene::Scene& scene = builtin(shadow->scene);
  scene::Geometry geometry = scene.geometry;
  tests::add_quad(geometry, {-20, shadow->floor, -20}, {40, 0, 0}, {0, 0, 40});
  scene::View view = view_of(scene, {128, 128});
  view.camera = shadow->camera;
  const VolumeOptions settings = settings_of(populate);

  const Axes axes = make_axes(glm::normalize(view.lights[0].position - view.camera.eye));
  const double theta_step = 2 * std::numbers::pi / settings.resolution.theta;
  const double phi_step = std::numbers::pi / settings.resolution.phi;
  int lit = 0, dark = 0, wrong = 0;
  for (const Seen& pixel : look(geometry, view, settings)) {
    if (std::abs(pixel.point.y - shadow->floor) > 1e-4) continue;  // on the occluder
    ++(pixel.is_lit ? lit : dark);
    const glm::dvec3 from_light = pixel.point - view.lights[0].position;
    const double x = glm::dot(from_light, axes.u), y = glm::dot(from_light, axes.f);
    const double theta = std::atan2(y, x);
    const double phi = std::atan2(std::hypot(x, y), -glm::dot(from_light, axes.axis));
    // Whether a light ray within a cell of the pixel's agrees. Three quarters more are for the slack of
    // voxelization, 5e-6 of the size of a triangle: that of the half-plane is 2000 m.
    bool is_near = false;
    for (double a = -1.75; a <= 1.75; a += 0.25) {
      for (double b = -1.75; b <= 1.75; b += 0.25) {
        const double t = theta + a * theta_step, p = phi + b * phi_step;
        const glm::dvec3 ray =
            std::sin(p) * (std::cos(t) * axes.u + std::sin(t) * axes.f) - std::cos(p) * axes.axis;
        const glm::dvec3 point = view.lights[0].position + from_light.y / ray.y * ray;
        is_near = is_near || shadow->is_lit(view.lights[0].position, point) == pixel.is_lit;
      }
    }
    wrong += !is_near;
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 300);
  EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Shadows, SurfaceLookupOn,
                         testing::Combine(testing::Values(Populate::shadow_map, Populate::conservative),
                                          testing::Values(&k_half_space, &k_sphere)));

class SurfaceLookupBy : public testing::TestWithParam<Populate> {};

TEST_P(SurfaceLookupBy, ABodyIsLitWhereItFacesTheLight) {
  const scene::Scene& scene = builtin("sphere");
  scene::View view = view_of(scene, {128, 128});
  view.camera = k_sphere.camera;
  int lit = 0, dark = 0, wrong = 0;
  for (const Seen& pixel : look(scene.geometry, view, settings_of(GetParam()))) {
    const double cosine =
        glm::dot(glm::normalize(pixel.point), glm::normalize(view.lights[0].position - pixel.point));
    // Where light grazes a facet, its neighbours, a thousandth of a radius away, may cast shadow.
    if (std::abs(cosine) < 0.1) continue;
    ++(pixel.is_lit ? lit : dark);
    wrong += pixel.is_lit != (cosine > 0);
  }
  EXPECT_GT(lit, 200);
  EXPECT_GT(dark, 200);
  EXPECT_EQ(wrong, 0);
}

TEST_P(SurfaceLookupBy, ALonePlaneIsLitWhollyAtAnySlope) {
  const scene::Geometry plane = tests::level_plane(12);
  for (double height : {5.0, 0.5, 0.05}) {
    const scene::View view = tests::view_of_level_plane({1, height, -1});
    for (int shadow_map_size : {128, 2048}) {
      for (Ranges ranges : {Ranges::frame, Ranges::full}) {
        int dark = 0;
        VolumeOptions settings = settings_of(GetParam());
        settings.ranges = ranges;
        for (const Seen& pixel : look(plane, view, settings, shadow_map_size)) dark += !pixel.is_lit;
        EXPECT_EQ(dark, 0) << "with the light at " << height << " and " << shadow_map_size << " texels";
      }
    }
  }
}

TEST_P(SurfaceLookupBy, AThinSheetIsDarkBehind) {
  const scene::Geometry sheet = tests::level_plane(50);
  for (const Seen& pixel : look(sheet, tests::view_of_level_plane({1, -2, -1}), settings_of(GetParam())))
    EXPECT_FALSE(pixel.is_lit);
}

INSTANTIATE_TEST_SUITE_P(Populates, SurfaceLookupBy,
                         testing::Values(Populate::shadow_map, Populate::conservative));

TEST(SurfaceLookup, ChargesNoTimeTwice) {
  const scene::Scene& scene = builtin("cornell");
  frame::Frame frame(tests::gpu_context(), scene.geometry, 256);
  SurfaceLookup lookup(tests::gpu_context(), {.resolution = {64, 128, 128}});
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(&tests::gpu_context());
  const auto start = std::chrono::steady_clock::now();
  frame.render(view_of(scene, {32, 32}), lookup, no_airlight, timer);
  const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - start;
  double sum = 0.0;
  std::vector<std::string> stages;
  for (const auto& [stage, ms] : timer.milliseconds()) {
    stages.push_back(stage);
    sum += ms;
    EXPECT_GE(ms, 0.0) << stage;
  }
  // The shadow map is made within the stage that asks for it.
  EXPECT_THAT(stages, testing::ElementsAre("composite", "populate", "ranges", "scan", "shadow_map",
                                           "surface_query", "surfaces"));
  EXPECT_LE(sum, whole.count());
  EXPECT_EQ(lookup.bytes().at("grid"), 64 * 128 * 128 / 8);
}

}  // namespace
}  // namespace airlight::epipolar
