#include "scene/scene.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"
#include "scene/light_texture.h"
#include "support/errors.h"

namespace airlight::scene {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// A few roundings of double precision.
constexpr double k_rounding = 1e-14;

void expect_near(glm::dvec3 a, glm::dvec3 b, double tolerance = k_rounding) {
  EXPECT_NEAR(glm::distance(a, b), 0.0, tolerance) << a.x << " " << a.y << " " << a.z;
}

/// Expects an error of that code whose message holds that text.
void expect_error(ExitCode code, const std::string& text, const std::function<void()>& act) {
  tests::expect_error(code, {text}, act);
}

Geometry triangle_geometry() {
  Geometry geometry;
  geometry.positions = {{1, 2, 3}, {4, 2, 3}, {1, 6, -1}, {100, 100, 100}};
  geometry.triangles = {{0, 1, 2}};
  geometry.material_of_triangle = {0};
  geometry.materials = {{}};
  return geometry;
}

View valid_view() {
  View view;
  view.lights[0].position = {0, 5, -3};
  return view;
}

TEST(Bounds, CoversTheVerticesOfTrianglesOnly) {
  const Box box = bounds(triangle_geometry());
  EXPECT_EQ(box.lower, glm::vec3(1, 2, -1));
  EXPECT_EQ(box.upper, glm::vec3(4, 6, 3));
}

TEST(Bounds, OfNothingIsEmpty) {
  EXPECT_TRUE(bounds({}).empty());
}

TEST(CameraFrame, HasOrthonormalAxesAndTheSlopesOfTheFieldOfView) {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.target = {1, 2, -7};
  camera.up = {0, 3, 4};  // neither of unit length nor perpendicular to the view
  camera.vertical_fov_degrees = 90.0;
  const CameraFrame frame = camera_frame(camera, {300, 200});
  expect_near(frame.eye, {1, 2, 3});
  expect_near(frame.forward, {0, 0, -1});
  expect_near(frame.right, {1, 0, 0});
  expect_near(frame.up, {0, 1, 0});
  EXPECT_NEAR(frame.half_height, 1.0, k_rounding);
  EXPECT_NEAR(frame.half_width, 1.5, k_rounding);
}

TEST(CameraFrame, IsRightHandedInAnyDirection) {
  Camera camera;
  camera.eye = {-3, 0.5, 2};
  camera.target = {5, -4, 7};
  const CameraFrame frame = camera_frame(camera, {64, 64});
  expect_near(glm::cross(frame.right, frame.up), -frame.forward);
  EXPECT_NEAR(glm::length(frame.forward), 1.0, k_rounding);
  EXPECT_NEAR(glm::dot(frame.right, camera.up), 0.0, k_rounding);
}

TEST(CameraFrame, StandsVeryCloseAndVeryFarTargetsAndAnyLengthOfUp) {
  Camera camera;
  for (double distance : {1e-200, 1e17}) {
    camera.target = {0, 0, -distance};
    camera.up = {0, distance, 0};
    expect_near(camera_frame(camera, {1, 1}).forward, {0, 0, -1});
    expect_near(camera_frame(camera, {1, 1}).up, {0, 1, 0});
  }
}

TEST(CameraFrame, RefusesWhatIsNoView) {
  const auto expect_refused = [](const std::string& text, glm::ivec2 size, auto&& change) {
    Camera camera;
    camera.name = "main";
    change(camera);
    expect_error(ExitCode::usage, text, [&] { camera_frame(camera, size); });
  };
  const auto keep = [](Camera&) {};
  expect_refused("camera 'main': an image of 0x5 has no pixels", {0, 5}, keep);
  expect_refused("an image of 5x-1", {5, -1}, keep);
  expect_refused("eye and target are both (0, 0, -1)", {1, 1}, [](Camera& c) { c.eye = c.target; });
  expect_refused("up is the zero vector", {1, 1}, [](Camera& c) { c.up = {0, 0, 0}; });
  expect_refused("up is parallel to the view", {1, 1}, [](Camera& c) { c.up = {0, 0, 2}; });
  expect_refused("up is parallel to the view", {1, 1}, [](Camera& c) { c.up = {1e-12, 0, -2}; });
  expect_refused("camera 'main', up: nan is not finite", {1, 1}, [](Camera& c) { c.up.y = k_nan; });
  expect_refused("camera 'main', eye: nan is not finite", {1, 1}, [](Camera& c) { c.eye.x = k_nan; });
  expect_refused("target: inf is not finite", {1, 1}, [](Camera& c) { c.target.z = k_infinity; });
  expect_refused("farther than 1e+18 m", {1, 1}, [](Camera& c) { c.target.z = -1e19; });
  for (double fov : {0.0, -1.0, 180.0, k_nan})
    expect_refused("fov", {1, 1}, [&](Camera& c) { c.vertical_fov_degrees = fov; });
}

TEST(Validate, AcceptsAView) {
  EXPECT_NO_THROW(validate(valid_view()));
  View view = valid_view();
  view.medium.sigma_s = view.medium.sigma_a = view.lights[0].intensity = glm::vec3(0.0f);
  view.medium.phase = PhaseFunction::henyey_greenstein;
  view.medium.g = -0.99f;
  EXPECT_NO_THROW(validate(view));
}

TEST(Validate, RefusesWhatNoMethodCanRender) {
  const auto expect_refused = [](ExitCode code, const std::string& text, auto&& change) {
    View view = valid_view();
    change(view);
    expect_error(code, text, [&] { validate(view); });
  };
  const ExitCode bad = ExitCode::bad_file;
  constexpr float k_nan_f = std::numeric_limits<float>::quiet_NaN();
  expect_refused(bad, "no light", [](View& v) { v.lights.clear(); });
  expect_refused(bad, "light 'second', position", [](View& v) {
    v.lights.push_back(point_light("second", {0, k_nan, 0}, glm::vec3(1.0f)));
  });
  expect_refused(bad, "at the eye, where the airlight is infinite",
                 [](View& v) { v.lights[0].position = v.camera.eye; });
  expect_refused(bad, "at the eye", [](View& v) { v.lights[0].position = v.camera.eye + glm::dvec3(1e-19); });
  expect_refused(bad, "light, position: nan", [](View& v) { v.lights[0].position.y = k_nan; });
  expect_refused(bad, "farther than", [](View& v) { v.lights[0].position.y = -2e18; });
  expect_refused(bad, "light 'sun', intensity: it must not be negative", [](View& v) {
    v.lights[0].name = "sun";
    v.lights[0].intensity.y = -1.0f;
  });
  expect_refused(bad, "intensity",
                 [](View& v) { v.lights[0].intensity.z = std::numeric_limits<float>::infinity(); });
  expect_refused(bad, "medium, sigma_s", [](View& v) { v.medium.sigma_s.x = -0.1f; });
  expect_refused(bad, "medium, sigma_s", [&](View& v) { v.medium.sigma_s.z = k_nan_f; });
  expect_refused(bad, "medium, sigma_a", [](View& v) { v.medium.sigma_a.y = -0.1f; });
  for (float g : {1.0f, -1.0f, 2.0f, k_nan_f})
    expect_refused(bad, "medium, g", [&](View& v) { v.medium.g = g; });
  for (float weight : {-0.1f, 1.1f, k_nan_f})
    expect_refused(bad, "medium, rayleigh_weight", [&](View& v) { v.medium.rayleigh_weight = weight; });
  expect_refused(bad, "medium, phase", [](View& v) { v.medium.phase = static_cast<PhaseFunction>(7); });
  expect_refused(ExitCode::usage, "no pixels", [](View& v) { v.size.x = 0; });
}

TEST(Validate, RefusesWhatNoSpotCanBe) {
  const auto expect_refused = [](const std::string& text, auto&& change) {
    View view;
    view.camera.eye = {0, 0, 5};
    view.lights[0].name = "spot";
    view.lights[0].cone.emplace();
    EXPECT_NO_THROW(validate(view));
    change(view.lights[0]);
    expect_error(ExitCode::bad_file, text, [&] { validate(view); });
  };
  expect_refused("light 'spot': it is a spot whose axis is no direction",
                 [](Light& light) { light.cone->axis = glm::dvec3(0.0); });
  expect_refused("light 'spot': it is a spot whose axis is no direction", [](Light& light) {
    light.cone->axis = {0, 1.1, 0};
  });
  expect_refused("light 'spot', target: nan is not finite", [](Light& light) { light.cone->axis.x = k_nan; });
  expect_refused("light 'spot', angles: the inner half-angle", [](Light& light) { light.cone->inner = 1.0; });
  expect_refused("light 'spot', angles: nan is not finite", [](Light& light) { light.cone->outer = k_nan; });
  expect_refused("light 'spot', range: -1 is not positive", [](Light& light) { light.range = -1; });
}

View sunny_view() {
  View view;
  view.lights = {sun("sun", {3, 4, 0}, glm::vec3(5.0f))};
  return view;
}

TEST(Validate, AcceptsASunWhereverTheEyeIs) {
  View view = sunny_view();
  EXPECT_NO_THROW(validate(view));
  view.camera.eye = view.lights[0].position;
  EXPECT_NO_THROW(validate(view));
  view.lights[0] = sun("low", {1, -1, 0}, glm::vec3(0.0f));
  EXPECT_NO_THROW(validate(view)) << "without a layer it may stand anywhere";
  view = sunny_view();
  view.medium.top = -10.0;
  EXPECT_NO_THROW(validate(view));
}

TEST(Validate, RefusesWhatNoSunCanBe) {
  const auto expect_refused = [](ExitCode code, const std::string& text, auto&& change) {
    View view = sunny_view();
    change(view);
    expect_error(code, text, [&] { validate(view); });
  };
  const ExitCode bad = ExitCode::bad_file;
  expect_refused(bad, "light 'sun', towards: nan is not finite",
                 [](View& v) { v.lights[0].towards.x = k_nan; });
  expect_refused(bad, "light 'sun', towards: it has no length",
                 [](View& v) { v.lights[0].towards = glm::dvec3(0.0); });
  expect_refused(bad, "light 'sun', irradiance: it must not be negative",
                 [](View& v) { v.lights[0].irradiance.y = -1.0f; });
  expect_refused(bad, "textured lights are lamps", [](View& v) {
    v.lights[0].texture =
        std::make_shared<LightTexture>("t", glm::ivec2(1), std::vector<glm::vec3>{glm::vec3(1.0f)});
  });
  expect_refused(bad, "no cone and no range", [](View& v) { v.lights[0].cone.emplace(); });
  expect_refused(bad, "no cone and no range", [](View& v) { v.lights[0].range = 1; });
  expect_refused(ExitCode::usage, "lower --irradiance", [](View& v) {
    v.lights[0].irradiance.z = 1e25f;
    v.medium.sigma_s.x = 2.0f;
  });
  for (double height : {0.0, -0.5, 1e-9})
    expect_refused(ExitCode::usage, "at or below the horizon never reaches", [&](View& v) {
      v.lights[0] = sun("low", {1, height, 0}, glm::vec3(1.0f));
      v.medium.top = 5.0;
    });
  expect_refused(bad, "medium, fog_top: inf is not finite", [](View& v) { v.medium.top = k_infinity; });
  expect_refused(bad, "medium, fog_top: 2e+18 is not between", [](View& v) { v.medium.top = 2e18; });
}

TEST(DirectionTo, IsTowardsTheLight) {
  expect_near(direction_to(point_light("", {1, 2, 3}, glm::vec3(1.0f)), {1, 0, 3}), {0, 1, 0});
  for (glm::dvec3 from : {glm::dvec3(0.0), glm::dvec3(1e9, 5, -7)})
    expect_near(direction_to(sunny_view().lights[0], from), {0.6, 0.8, 0});
}

TEST(FitCamera, SeesAllOfTheGeometry) {
  Geometry geometry;
  geometry.materials = {{}};
  for (int i = 0; i < 8; ++i)
    geometry.positions.emplace_back(i & 1 ? 5e4 : 1e4, i & 2 ? 300 : -20, i & 4 ? 7e4 : 2e4);
  for (glm::uint i = 0; i + 2 < 8; ++i) geometry.triangles.emplace_back(i, i + 1, i + 2);

  const CameraFrame frame = camera_frame(fit_camera(geometry), {100, 100});
  for (glm::vec3 position : geometry.positions) {
    const glm::dvec3 to = glm::dvec3(position) - frame.eye;
    const double depth = glm::dot(to, frame.forward);
    ASSERT_GT(depth, 0.0);
    EXPECT_LT(std::abs(glm::dot(to, frame.right)), depth * frame.half_width);
    EXPECT_LT(std::abs(glm::dot(to, frame.up)), depth * frame.half_height);
  }
  EXPECT_LT(frame.forward.z, 0.0) << "from the front";
  EXPECT_LT(frame.forward.y, 0.0) << "from slightly above";
  EXPECT_GT(frame.forward.y, -0.5);
}

TEST(FitCamera, OfNothingIsAViewNevertheless) {
  EXPECT_NO_THROW(camera_frame(fit_camera({}), {1, 1}));
}

TEST(Error, SaysWhereWhatAndWhatToDo) {
  EXPECT_STREQ(Error(ExitCode::usage, "--fov", "it is zero").what(), "--fov: it is zero");
  EXPECT_STREQ(Error(ExitCode::usage, "--fov", "it is zero", "give more").what(),
               "--fov: it is zero; give more");
}

}  // namespace
}  // namespace airlight::scene
