#include "scene/path.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/builtin.h"
#include "scene/error.h"
#include "scene/view_fields.h"
#include "support/errors.h"
#include "support/paths.h"

namespace airlight::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using D = glm::dvec3;
using V = glm::vec3;

class PathFile : public testing::Test {
 protected:
  PathFile() {
    file_ = std::filesystem::path(testing::TempDir()) /
            (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + " path.toml");
    view_.camera.eye = {0, 1, 5};
    view_.camera.target = {0, 1, 0};
    view_.lights = {point_light("lamp", {0, 3, 0}, V(2.0f))};
  }
  ~PathFile() override { std::filesystem::remove(file_); }

  Path load(std::string_view content) {
    std::ofstream(file_, std::ios::binary) << content;
    return load_path(file_, view_);
  }

  void expect_error(std::string_view content, const std::string& text) {
    tests::expect_error(ExitCode::bad_file, {text, " path.toml"}, [&] { load(content); });
  }

  std::filesystem::path file_;
  View view_;
};

const std::string k_head = "frames = 5\nseconds = 2\n";

TEST_F(PathFile, WithoutKeysRests) {
  const Path path = load(k_head);
  ASSERT_EQ(path.views.size(), 5u);
  EXPECT_EQ(path.seconds, 2.0);
  EXPECT_EQ(path.time(0), 0.0);
  EXPECT_EQ(path.time(1), 0.5);
  EXPECT_EQ(path.time(4), 2.0);
  EXPECT_EQ(load("frames = 1\nseconds = 2").time(0), 0.0);
  for (std::size_t i = 1; i < 5; ++i)
    EXPECT_EQ(motion_between(path.views[i - 1], path.views[i]), Motion::nothing);
}

TEST_F(PathFile, MovesWhatItsKeysGive) {
  const Path path = load(
      k_head +
      "[[camera]]\ntime = 0\neye = [0, 1, 5]\nfov = 40\n[[camera]]\ntime = 1\neye = [1, 1, 4]\n"
      "[[camera]]\ntime = 2\neye = [4, 1, 1]\nfov = 50\nup = [0, 1, 0.1]\n"
      "[[light]]\nname = 'lamp'\ntime = 0.5\nposition = [0, 3, 1]\n[[light]]\ntime = 1\nintensity = 7\n");
  EXPECT_EQ(path.views[0].camera.eye, D(0, 1, 5));
  EXPECT_EQ(path.views[2].camera.eye, D(1, 1, 4));
  EXPECT_EQ(path.views[4].camera.eye, D(4, 1, 1));
  EXPECT_EQ(path.views[2].camera.vertical_fov_degrees, 45.0) << "half way between the keys that give it";
  for (const View& view : path.views) {
    EXPECT_EQ(view.camera.target, view_.camera.target) << "no key gives it";
    EXPECT_EQ(view.camera.up, D(0, 1, 0.1)) << "one key gives it";
    EXPECT_EQ(view.lights[0].position, D(0, 3, 1));
    EXPECT_EQ(view.lights[0].intensity, V(7.0f));
    EXPECT_EQ(view.lights[0].name, "lamp");
  }
  EXPECT_THAT(path.warnings, IsEmpty());
}

TEST_F(PathFile, FindsLightsByNameAndNumber) {
  view_.lights.push_back(point_light("", {1, 3, 0}, V(1.0f)));
  view_.lights.push_back(sun("0", {0, 1, 0}, V(1.0f)));
  const Path path =
      load(k_head +
           "[[light]]\nname = 'light1'\ntime = 0\nintensity = 4\n[[light]]\nname = 'lamp'\ntime = 0\n"
           "intensity = 5\n[[sun]]\nname = '0'\ntime = 0\nirradiance = 6\n");
  EXPECT_EQ(path.views[0].lights[0].intensity, V(5.0f));
  EXPECT_EQ(path.views[0].lights[1].intensity, V(4.0f));
  EXPECT_EQ(path.views[0].lights[2].irradiance, V(6.0f)) << "a name is preferred to a number";
  EXPECT_EQ(load(k_head + "[[light]]\nname = '1'\ntime = 0\nintensity = 9\n").views[0].lights[1].intensity,
            V(9.0f));
  expect_error(
      k_head + "[[light]]\ntime = 0\nintensity = 4\n",
      "line 3, light.name: the view has several lights; name one of 'lamp' (0), 'light1' (1), '0' (2)");
  expect_error(k_head + "[[light]]\nname = 'moon'\ntime = 0\n",
               "line 4, light.name: the view has no light 'moon'; it has 'lamp' (0)");
}

TEST_F(PathFile, SunsTurn) {
  view_.lights = {sun("sun", {0, 1, 0}, V(1.0f))};
  const Path path =
      load(k_head + "[[sun]]\ntime = 0\ntowards = [0, 20, 0]\n[[sun]]\ntime = 2\nangles = [90, 0]\n");
  EXPECT_EQ(path.views[0].lights[0].towards, D(0, 1, 0));
  for (const View& view : path.views) EXPECT_NEAR(glm::length(view.lights[0].towards), 1.0, 1e-12);
  EXPECT_NEAR(glm::distance(path.views[2].lights[0].towards, glm::normalize(D(1, 1, 0))), 0.0, 1e-12)
      << "keys are of unit length before the curve";
  expect_error(k_head + "[[sun]]\ntime = 0\ntowards = [0, 1, 0]\n[[sun]]\ntime = 2\ntowards = [0, -1, 0]\n",
               "frame 2 (1 s): sun, towards: it has no length");
  expect_error(k_head + "[[sun]]\ntime = 0\ntowards = [0, 1, 0]\nangles = [0, 45]\n",
               "line 5, sun.towards: angles contradicts it");
  expect_error(k_head + "[[light]]\ntime = 0\nposition = [0, 1, 0]\n",
               "line 5, light.position: the light is a sun");
}

TEST_F(PathFile, ColoursStayAbove0AndItSaysSo) {
  const Path path = load(
      "frames = 31\nseconds = 3\n[[light]]\ntime = 0\nintensity = [9, 1, 1]\n[[light]]\ntime = 1\n"
      "intensity = [0.1, 1, 1]\n[[light]]\ntime = 2\nintensity = [0, 1, 1]\n[[light]]\ntime = 3\nintensity = "
      "1\n");
  for (const View& view : path.views) EXPECT_GE(view.lights[0].intensity.r, 0.0f);
  EXPECT_THAT(path.warnings, ElementsAre(HasSubstr("lamp's intensity goes below 0")));
}

TEST_F(PathFile, ErrorsNameFileLineAndKey) {
  expect_error("seconds = 1", "frames: it is missing");
  expect_error("frames = 3", "seconds: it is missing");
  expect_error("frames = 0\nseconds = 1", "line 1, frames: it must be a whole number, at least 1");
  expect_error("frames = 20000\nseconds = 1", "line 1, frames: 20000 are more than 10000");
  expect_error("frames = 3\nseconds = -1", "line 2, seconds: -1 is not between");
  expect_error("frames = 3\nseconds = nan", "line 2, seconds: nan is not between");
  expect_error("frames = 3\nseconds = \n", "line 2: ");
  expect_error(k_head + "speed = 1\n",
               "line 3: there is no key 'speed'; use camera, frames, light, node, seconds, sun");
  expect_error(k_head + "[camera]\ntime = 0\n",
               "line 3, camera: it must be tables, each begun by [[camera]]");
  expect_error(k_head + "[[camera]]\neye = [0, 0, 1]\n", "line 3, camera.time: it is missing");
  expect_error(k_head + "[[camera]]\ntime = 2.5\n",
               "line 4, camera.time: 2.5 is not between 0 and 2 seconds");
  expect_error(k_head + "[[camera]]\ntime = 1\n[[camera]]\ntime = 1\n",
               "line 6, camera.time: 1 is not later than the key before, at 1");
  expect_error(k_head + "[[camera]]\ntime = 1\nroll = 3\n", "line 5: there is no key 'roll' in [[camera]]");
  expect_error(k_head + "[[camera]]\ntime = 1\neye = 3\n", "line 5, camera.eye: it must be three numbers");
  expect_error(k_head + "[[camera]]\ntime = 1\nfov = 300\n",
               "line 5, camera.fov: 300 is not between 0 and 180");
  expect_error(k_head + "[[light]]\ntime = 1\nintensity = -1\n",
               "line 5, light.intensity: it must not be negative");
  expect_error(k_head + "[[light]]\ntime = 1\ntexture = 'a.exr'\n", "line 5: there is no key 'texture'");
  expect_error(k_head + "[[sun]]\ntime = 1\nirradiance = 1\n", "line 5, sun.irradiance: the light is a lamp");
  EXPECT_THROW(load_path("no such path.toml", view_), Error);
}

TEST_F(PathFile, EveryFrameIsAViewThatCanBe) {
  expect_error(k_head + "[[camera]]\ntime = 0\neye = [0, 1, 4]\n[[camera]]\ntime = 2\neye = [0, 1, -4]\n",
               "frame 2 (1 s): camera: eye and target are both");
  expect_error(k_head +
                   "[[camera]]\ntime = 0\neye = [0, 3, 4]\ntarget = [5, 3, 0]\n[[camera]]\ntime = 2\neye = "
                   "[0, 3, -4]\n",
               "frame 2 (1 s): light 'lamp': it is at the eye");
}

TEST(Motion, IsOfObjectsWhateverElseMoves) {
  View before;
  before.pose.objects = std::make_shared<const Objects>(Objects{{"door"}, {1}});
  before.pose.motions = {Rigid{}};
  View after = before;
  EXPECT_EQ(motion_name(motion_between(before, after)), "nothing");
  after.pose.motions[0].matrix[3].x = 1.0;
  EXPECT_EQ(motion_name(motion_between(before, after)), "objects");
  after.camera.target.x += 1.0;
  EXPECT_EQ(motion_name(motion_between(before, after)), "objects");
}

TEST(Motion, IsOfTheCameraAndOfLights) {
  View before;
  before.lights = {point_light("a", {0, 1, 0}, V(1.0f)), sun("b", {0, 1, 0}, V(1.0f))};
  View after = before;
  EXPECT_EQ(motion_name(motion_between(before, after)), "nothing");
  after.lights[0].intensity = V(2.0f);
  after.lights[1].irradiance = V(2.0f);
  EXPECT_EQ(motion_name(motion_between(before, after)), "nothing") << "no shadow moves";
  after.lights[1].towards = {1, 0, 0};
  EXPECT_EQ(motion_name(motion_between(before, after)), "lights");
  after.camera.target.x += 1.0;
  EXPECT_EQ(motion_name(motion_between(before, after)), "all");
  after.lights = before.lights;
  EXPECT_EQ(motion_name(motion_between(before, after)), "camera");
}

TEST(PathsOfTheProject, Load) {
  for (const auto& [name, builtin] : {std::pair{"window_flight", "window"},
                                      {"window_walk", "window"},
                                      {"nave_evening", "nave"},
                                      {"forest_walk", "forest"},
                                      {"jali_morning", "jali"},
                                      {"lighthouse_turn", "lighthouse"},
                                      {"harbour_evening", "harbour"}}) {
    const Scene scene = find_builtin(builtin)->make({});
    const Path path = load_path(AIRLIGHT_ASSETS / "paths" / (std::string(name) + ".toml"),
                                {scene.cameras[0], scene.lights, scene.medium, {64, 64}});
    EXPECT_EQ(path.views.size(), 48u) << name;
    EXPECT_THAT(path.warnings, IsEmpty()) << name;
  }
}

}  // namespace
}  // namespace airlight::scene
