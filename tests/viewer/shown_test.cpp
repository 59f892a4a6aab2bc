#include "viewer/shown.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

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

}  // namespace
}  // namespace airlight::viewer
