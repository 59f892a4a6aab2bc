#include "viewer/shown.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "scene/path.h"
#include "scene/shot.h"

namespace airlight::viewer {
namespace {

using testing::HasSubstr;

Shown shown() {
  Shown shown{.view = {},
              .volume = quality::parse_volumes("vsv:phi=256:where=half")[0],
              .surface = quality::parse_surfaces("shadow-map")[0],
              .shadow_map = 1024,
              .exposure = 2.5f};
  shown.view.camera.eye = {-0.1, 1.0 / 3.0, 4};
  shown.view.camera.target = {0, 1, -0.25};
  shown.view.lights = {scene::point_light("one", {-1.5, 2, 3}, {1, 2, 3})};
  shown.view.medium.sigma_s = {0.1f, 0.2f, 0.30000001f};
  shown.view.medium.phase = scene::PhaseFunction::henyey_greenstein;
  shown.view.medium.g = -0.3f;
  shown.view.size = {640, 360};
  return shown;
}

TEST(ShownPictures, AreCommands) {
  const std::string command = command_of({"a scene.glb", {}, {}}, shown(), "x.exr");
  EXPECT_THAT(command, testing::StartsWith("airlight render 'a scene.glb' "));
  EXPECT_THAT(command, HasSubstr(" --eye=-0.1,0.3333333333333333,4 "));
  EXPECT_THAT(command, HasSubstr(" --light-position=-1.5,2,3 --intensity=1,2,3 "));
  EXPECT_THAT(command, HasSubstr(" --phase=henyey-greenstein --g=-0.3 "));
  EXPECT_THAT(command, HasSubstr(" --size=640x360 "));
  EXPECT_THAT(command,
              HasSubstr(" --shadow-map=1024 --volume=vsv:phi=256:where=half --surface=shadow-map -o x.exr"));
  // What no method reads cannot be given.
  Shown without = shown();
  without.volume = quality::parse_volumes("none")[0];
  without.surface = quality::parse_surfaces("none")[0];
  EXPECT_THAT(command_of({"window", {}, {}}, without, "x.exr"), testing::Not(HasSubstr("--shadow-map")));
}

TEST(ShownPictures, SayWhatALightIsFirst) {
  Shown two = shown();
  scene::Light spot = scene::point_light("spot", {1, 2, 3}, glm::vec3(5));
  spot.cone = scene::Cone{.axis = {0, -1, 0}, .inner = 0.2, .outer = 0.4};
  spot.range = 7.0;
  two.view.lights = {scene::sun("day", {0, 1, 1}, glm::vec3(2)), spot};
  const std::string command = command_of({"window", "5000", {}}, two, "x.exr");
  EXPECT_LT(command.find("--sun="), command.find("--irradiance="));
  EXPECT_LT(command.find("--irradiance="), command.find("--light-position="));
  EXPECT_LT(command.find("--light-position="), command.find("--spot-angles="));
  EXPECT_THAT(command, HasSubstr("--range=7"));
  EXPECT_THAT(command, HasSubstr("--triangles=5000"));
}

TEST(ShownPictures, AreShotsThatReadBackTheSame) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("airlight-shown-" + std::to_string(getpid()) + ".toml");
  Shown two = shown();
  scene::Light spot = scene::point_light("", {1, 2, 3}, glm::vec3(5));
  spot.cone = scene::Cone{.axis = {0, -1, 0}, .inner = 0.0, .outer = 0.4};
  two.view.lights.push_back(spot);
  two.view.lights.push_back(scene::sun("", {0, 1, 1}, {2, 1, 0.5}));
  two.view.medium.top = 12.5;
  two.view.surroundings = {{0.1f, 0.2f, 0.3f}, {1, 2, 3}};
  two.tone_map = scene::ToneMap::agx;
  for (const Shown& written : {shown(), two}) {
    std::ofstream(file) << shot_of({"spheres", "6000", {}}, written);
    const scene::Scene read = scene::load_shot(file);
    const scene::Camera& camera = read.cameras[0];
    EXPECT_EQ(camera.eye, written.view.camera.eye);
    EXPECT_EQ(camera.target, written.view.camera.target);
    EXPECT_EQ(camera.up, written.view.camera.up);
    EXPECT_EQ(camera.vertical_fov_degrees, written.view.camera.vertical_fov_degrees);
    EXPECT_EQ(read.medium, written.view.medium);
    EXPECT_EQ(read.exposure, written.exposure);
    EXPECT_EQ(read.tone_map, written.tone_map);
    EXPECT_EQ(read.surroundings, written.view.surroundings);
    ASSERT_EQ(read.lights.size(), written.view.lights.size());
    for (std::size_t i = 0; i < read.lights.size(); ++i) {
      scene::Light light = written.view.lights[i];
      light.name = read.lights[i].name;
      // A direction is brought to unit length once more, and an angle goes by way of degrees.
      EXPECT_LT(glm::distance(light.towards, read.lights[i].towards), 1e-15);
      light.towards = read.lights[i].towards;
      if (light.cone) {
        EXPECT_NEAR(light.cone->outer, read.lights[i].cone->outer, 1e-15);
        EXPECT_LT(glm::distance(light.cone->axis, read.lights[i].cone->axis), 1e-15);
        light.cone = read.lights[i].cone;
      }
      EXPECT_EQ(read.lights[i], light) << i;
    }
  }
  std::filesystem::remove(file);
}

TEST(ShownPictures, ArePathsOfWhatMoves) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("airlight-path-" + std::to_string(getpid()) + ".toml");
  scene::View view = shown().view;
  scene::Light spot = scene::point_light("", {1, 2, 3}, glm::vec3(5));
  spot.cone = scene::Cone{.axis = glm::normalize(glm::dvec3(1, -1, 0)), .inner = 0.1, .outer = 0.4};
  view.lights.push_back(spot);
  view.lights.push_back(scene::sun("day", {0, 1, 1}, {2, 1, 0.5}));
  view.lights.push_back(scene::point_light("rests", {0, 1, 0}, glm::vec3(1)));
  std::vector<PathKey> keys = {{0.0, view.camera, view.lights}, {1.0, view.camera, view.lights}};
  keys[1].camera.eye.y += 0.5;
  keys[1].lights[0].position.x += 1.0 / 3.0;
  keys[1].lights[1].position.y += 2.0;  // the axis stays
  keys[0].lights[2].irradiance = {1, 1, 0.25};
  keys[1].lights[2].towards = glm::normalize(glm::dvec3(1, 2, 3));

  std::string text = path_of(keys, view.lights);
  EXPECT_THAT(text, testing::Not(HasSubstr("\"3\""))) << "what rests is not in it";
  std::ofstream(file) << text;
  const scene::Path path = scene::load_path(file, view);
  ASSERT_EQ(path.views.size(), 31u);
  for (const PathKey& key : keys) {
    const scene::View& at = key.time == 0.0 ? path.views.front() : path.views.back();
    EXPECT_EQ(at.camera, key.camera);
    ASSERT_TRUE(are_same_lights(at.lights, key.lights));
    for (std::size_t i = 0; i < key.lights.size(); ++i) {
      // Directions are brought to unit length once more, angles go by way of degrees.
      EXPECT_EQ(at.lights[i].position, key.lights[i].position) << i;
      EXPECT_EQ(at.lights[i].intensity, key.lights[i].intensity) << i;
      EXPECT_EQ(at.lights[i].irradiance, key.lights[i].irradiance) << i;
      EXPECT_LT(glm::distance(at.lights[i].towards, key.lights[i].towards), 1e-15) << i;
      ASSERT_EQ(at.lights[i].cone.has_value(), key.lights[i].cone.has_value());
      if (at.lights[i].cone) {
        EXPECT_LT(glm::distance(at.lights[i].cone->axis, spot.cone->axis), 1e-15);
      }
    }
  }
  EXPECT_LT(glm::distance(path.views[15].lights[1].cone->axis, spot.cone->axis), 1e-15);
  EXPECT_NEAR(path.views[15].lights[1].position.y, 3.0, 1e-12);

  // A lone light needs no name, and is as all keys have it where the view has it otherwise.
  const std::vector<scene::Light> elsewhere = {scene::point_light("one", {9, 9, 9}, {1, 2, 3})};
  for (PathKey& key : keys) key.lights = {shown().view.lights[0]};
  text = path_of(keys, elsewhere);
  EXPECT_THAT(text, testing::AllOf(testing::Not(HasSubstr("name")), testing::Not(HasSubstr("intensity"))));
  std::ofstream(file) << text;
  view.lights = elsewhere;
  for (const scene::View& at : scene::load_path(file, view).views)
    EXPECT_EQ(at.lights[0].position, keys[0].lights[0].position);
  EXPECT_FALSE(are_same_lights(elsewhere, {}));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace airlight::viewer
