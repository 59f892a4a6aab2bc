#include "scene/shot.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"
#include "support/errors.h"
#include "support/paths.h"

namespace airlight::scene {
namespace {

using testing::HasSubstr;

using V = glm::vec3;
using D = glm::dvec3;

/// A folder of one test's files, which goes away with the test.
class Shot : public testing::Test {
 protected:
  Shot() {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("airlight_shot_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "models");
    write("models/one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  ~Shot() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, std::string_view content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  Scene load(std::string_view content) { return load_shot(write("a shot.toml", content)); }

  void expect_error(std::string_view content, const std::string& text) {
    tests::expect_error(ExitCode::bad_file, {text, "a shot.toml"}, [&] { load(content); });
  }

  std::filesystem::path folder_;
};

TEST_F(Shot, ShowsABuiltinSceneAsItIsUnlessItSaysMore) {
  const Scene scene = load("scene = \"cornell\"");
  EXPECT_EQ(scene.name, "a shot");
  EXPECT_EQ(scene.geometry.triangles.size(), 84u);
  EXPECT_EQ(scene.cameras.at(0).name, "front");
  EXPECT_EQ(scene.lights.at(0).name, "ceiling");
  EXPECT_EQ(scene.exposure, 5.0f);
  EXPECT_EQ(load("scene = \"spheres\"\ntriangles = 2000").geometry.triangles.size(), 2000u);
}

TEST_F(Shot, SaysEverythingOfAView) {
  const Scene scene = load(
      "# whole and broken numbers alike\nscene = 'models/one.obj'\nexposure = 4\nalbedo = [0.1, 0.2, 0]\n"
      "[camera]\neye = [0, 1, 4]\ntarget = [0.5, 1.0, 0]\nup = [1, 0, 0]\nfov = 38\n"
      "[light]\nposition = [0, 2, 1]\nintensity = [1, 2.5, 3e1]\n"
      "[medium]\nsigma_s = 0.25\nsigma_a = [0, 0.1, 0.2]\nphase = \"henyey-greenstein\"\ng = -0.5\n");
  EXPECT_EQ(scene.geometry.triangles.size(), 1u);
  EXPECT_EQ(scene.geometry.materials.at(scene.geometry.material_of_triangle.at(0)).albedo,
            V(0.1f, 0.2f, 0.0f));
  EXPECT_EQ(scene.exposure, 4.0f);
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.eye, D(0, 1, 4));
  EXPECT_EQ(camera.target, D(0.5, 1, 0));
  EXPECT_EQ(camera.up, D(1, 0, 0));
  EXPECT_EQ(camera.vertical_fov_degrees, 38.0);
  EXPECT_EQ(scene.lights.at(0).position, D(0, 2, 1));
  EXPECT_EQ(scene.lights.at(0).intensity, V(1, 2.5f, 30));
  EXPECT_EQ(scene.medium.sigma_s, V(0.25f));
  EXPECT_EQ(scene.medium.sigma_a, V(0, 0.1f, 0.2f));
  EXPECT_EQ(scene.medium.phase, PhaseFunction::henyey_greenstein);
  EXPECT_EQ(scene.medium.g, -0.5f);
}

TEST_F(Shot, ChangesPartsOfWhatTheSceneBrings) {
  const Scene scene = load(
      "scene = 'cornell'\n[camera]\nname = 'front'\nfov = 50\n[light]\nname = 'ceiling'\nintensity = 7\n"
      "[medium]\nphase = 'rayleigh'\n");
  EXPECT_EQ(scene.cameras.at(0).eye, D(0, 1, 4.2));
  EXPECT_EQ(scene.cameras.at(0).vertical_fov_degrees, 50.0);
  EXPECT_EQ(scene.lights.at(0).intensity, V(7));
  EXPECT_EQ(scene.lights.at(0).position, D(0, 1.85, 0));
  EXPECT_EQ(scene.medium.phase, PhaseFunction::rayleigh);
  EXPECT_EQ(scene.medium.sigma_s, V(0.25f));

  const Scene added = load("scene = 'cornell'\n[camera]\neye = [0, 1, 3]\ntarget = [0, 1, 0]\n");
  ASSERT_EQ(added.cameras.size(), 2u);
  EXPECT_EQ(added.cameras[0].eye, D(0, 1, 3));
  EXPECT_EQ(added.cameras[1].name, "front");
}

TEST_F(Shot, OfAFileMayLeaveOutEverything) {
  const Scene scene = load("scene = 'models/one.obj'");
  EXPECT_EQ(scene.cameras.at(0).name, "fitted");
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.exposure, std::nullopt);
}

TEST_F(Shot, TrianglesAskedForOverrideItsOwn) {
  const auto file = write("s.toml", "scene = 'spheres'\ntriangles = 8000\n");
  EXPECT_EQ(load_shot(file, 2000).geometry.triangles.size(), 2000u);
  EXPECT_EQ(load_shot(file).geometry.triangles.size(), 8000u);
  for (const auto& [text, count] : {std::pair{"scene = 'spheres'", 10u}, {"scene = 'cornell'", 5000u}}) {
    try {
      load_shot(write("s.toml", text), count);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code, ExitCode::usage);
      EXPECT_THAT(error.what(), HasSubstr("--triangles"));
    }
  }
  expect_error("scene = 'spheres'\ntriangles = 10", "line 2, triangles: 10 is not between 2000");
  expect_error("scene = 'cornell'\ntriangles = 5000",
               "line 2, triangles: the triangles of cornell are given");
  for (const char* bad : {"-5", "2e3", "'many'"})
    expect_error("scene = 'spheres'\ntriangles = " + std::string(bad),
                 "line 2, triangles: it must be a whole number");
}

TEST_F(Shot, RefusesKeysThatItDoesNotKnow) {
  expect_error("scene = 'cornell'\nmood = 1\n",
               "line 2: there is no key 'mood'; use albedo, ambient, background");
  expect_error("scene = 'cornell'\n[camera]\nfov = 40\nroll = 1\n",
               "line 4: there is no key 'roll' in [camera]");
  expect_error("scene = 'cornell'\n[light]\nlight_position = 1\n",
               "line 3: there is no key 'light_position' in [light]");
  expect_error("scene = 'cornell'\n[medium]\nsigma-s = 1\n", "line 3: there is no key 'sigma-s' in [medium]");
  expect_error("scene = 'cornell'\n[moon]\n", "line 2: there is no key 'moon'");
  expect_error("scene = 'cornell'\n[sun]\nname = 'sun'\n", "line 3: there is no key 'name' in [sun]");
}

TEST_F(Shot, RefusesValuesOfTheWrongType) {
  const std::string scene = "scene = 'cornell'\n";
  expect_error("scene = 7\n", "line 1, scene: it must be a text");
  expect_error(scene + "exposure = 'bright'\n", "line 2, exposure: it must be a number");
  expect_error(scene + "exposure = true\n", "line 2, exposure: it must be a number");
  expect_error(scene + "camera = 'front'\n", "line 2, camera: it must be a table");
  expect_error(scene + "[[camera]]\nfov = 40\n", "camera: it must be a table");
  expect_error(scene + "[camera]\neye = [0, 1]\n", "line 3, camera.eye: it must be three numbers");
  expect_error(scene + "[camera]\neye = 1\n", "line 3, camera.eye: it must be three numbers");
  expect_error(scene + "[camera]\neye = [0, 1, 'x']\n", "line 3, camera.eye: it must be three numbers");
  expect_error(scene + "[medium]\nsigma_s = [0, 1]\n",
               "line 3, medium.sigma_s: it must be a number or three");
  expect_error(scene + "[medium]\nphase = 1\n", "line 3, medium.phase: it must be a text");
}

TEST_F(Shot, RefusesValuesThatCannotBe) {
  const std::string scene = "scene = 'cornell'\n";
  expect_error(scene + "exposure = nan\n", "line 2, exposure: nan is not finite");
  expect_error(scene + "exposure = -inf\n", "line 2, exposure: -inf is not finite");
  for (const char* bad : {"0", "-1", "1e39", "1e-60"})
    expect_error(scene + "exposure = " + bad, "line 2, exposure: ");
  expect_error(scene + "albedo = [0, 1.5, 0]\n", "line 2, albedo: it is more than 1");
  expect_error(scene + "[camera]\nfov = 180\n", "line 3, camera.fov: 180 is not between");
  expect_error(scene + "[camera]\neye = [0, nan, 0]\ntarget = [0, 0, 0]\n",
               "line 3, camera.eye: nan is not finite");
  expect_error(scene + "[camera]\neye = [0, 0, 0]\n", "line 3, camera.eye: it needs target");
  expect_error(scene + "[camera]\ntarget = [0, 0, 0]\n", "line 3, camera.target: it needs eye");
  expect_error(scene + "[camera]\nname = 'front'\neye = [0, 0, 1]\ntarget = [0, 0, 0]\n",
               "line 3, camera.name: ");
  expect_error(scene + "[camera]\nname = 'back'\n",
               "line 3, camera.name: the scene has no 'back'; it has 'front'");
  expect_error(scene + "[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 1]\n", "eye and target");
  expect_error(scene + "[light]\nname = 'sun'\n",
               "line 3, light.name: the scene has no 'sun'; it has 'ceiling'");
  expect_error(scene + "[light]\nposition = [0, 1, 0]\n", "line 3, light.position: it needs intensity");
  expect_error(scene + "[light]\nintensity = -1\n", "line 3, light.intensity: it must not be negative");
  expect_error(scene + "[light]\nintensity = 1e39\n", "line 3, light.intensity: it is too large");
  expect_error(scene + "[light]\nposition = [0, 1, 4.2]\nintensity = 1\n", "infinite");
  expect_error("scene = 'models/one.obj'\n[light]\nintensity = 1\n",
               "line 3, light.intensity: the scene has no light");
  expect_error(scene + "[medium]\nsigma_a = inf\n", "line 3, medium.sigma_a: inf is not finite");
  expect_error(scene + "[medium]\nphase = 'mie'\n", "line 3, medium.phase: 'mie' is unknown");
  expect_error(scene + "[medium]\nphase = 'henyey-greenstein'\ng = 1\n",
               "line 4, medium.g: 1 is not between");
  expect_error(scene + "[medium]\nphase = 'hoffman-preetham'\nrayleigh_weight = 2\n",
               "line 4, medium.rayleigh_weight: 2 is not between 0 and 1");
  expect_error(scene + "[medium]\nrayleigh_weight = 0.5\n",
               "line 3, medium.rayleigh_weight: the phase function isotropic mixes nothing");
  expect_error(scene + "[medium]\ng = 0.5\n", "line 3, medium.g: the phase function isotropic has no g");
}

TEST_F(Shot, HasASunInPlaceOfALamp) {
  const Scene scene = load(
      "scene = 'cornell'\n[sun]\ntowards = [0, 3, 4]\nirradiance = [3, 2.5, 1]\n"
      "[medium]\nfog_top = 16\n");
  ASSERT_EQ(scene.lights.size(), 1u) << "it stands in for the scene's";
  EXPECT_EQ(scene.other_lights.at(0).name, "ceiling");
  const Light& sun = scene.lights[0];
  ASSERT_TRUE(is_sun(sun));
  EXPECT_NEAR(glm::distance(sun.towards, D(0, 0.6, 0.8)), 0.0, 1e-15);
  EXPECT_EQ(sun.irradiance, V(3, 2.5f, 1));
  EXPECT_EQ(scene.medium.top, 16.0);

  const Light by_angles =
      load("scene = 'models/one.obj'\n[sun]\nangles = [90, 30]\nirradiance = 2\n").lights.at(0);
  ASSERT_TRUE(is_sun(by_angles));
  EXPECT_NEAR(glm::distance(by_angles.towards, D(std::sqrt(0.75), 0.5, 0)), 0.0, 1e-15);
  EXPECT_EQ(by_angles.irradiance, V(2));
}

std::vector<std::string> names_of(const std::vector<Light>& lights) {
  std::vector<std::string> names;
  for (const Light& light : lights) names.push_back(light.name);
  return names;
}

TEST_F(Shot, HasSeveralLightsWithKeysOfEitherKind) {
  const Scene scene = load(
      "scene = 'cornell'\n"
      "[[light]]\nposition = [0, 1, 0]\nintensity = [1, 2, 3]\n"
      "[[light]]\nname = 'ceiling'\nintensity = 7\n"
      "[[light]]\ntowards = [0, 3, 4]\nirradiance = 5\n"
      "[[light]]\nangles = [90, 0]\nirradiance = 6\n");
  EXPECT_THAT(names_of(scene.lights), testing::ElementsAre("light0", "ceiling", "light2", "light3"));
  EXPECT_EQ(scene.lights[0].position, D(0, 1, 0));
  EXPECT_EQ(scene.lights[0].intensity, V(1, 2, 3));
  EXPECT_EQ(scene.lights[1].position, D(0, 1.85, 0));
  EXPECT_EQ(scene.lights[1].intensity, V(7));
  ASSERT_TRUE(is_sun(scene.lights[2]) && is_sun(scene.lights[3]));
  EXPECT_NEAR(glm::distance(scene.lights[2].towards, D(0, 0.6, 0.8)), 0.0, 1e-15);
  EXPECT_EQ(scene.lights[2].irradiance, V(5));
  EXPECT_NEAR(glm::distance(scene.lights[3].towards, D(1, 0, 0)), 0.0, 1e-15);
}

TEST_F(Shot, KeepsTheLightsOfItsSceneOrAllOfThemAndMore) {
  EXPECT_THAT(names_of(load("scene = 'cornell'\n").lights), testing::ElementsAre("ceiling"));
  EXPECT_THAT(names_of(load("scene = 'cornell'\n[light]\n").lights), testing::ElementsAre("ceiling"));
  EXPECT_THAT(names_of(load("scene = 'cornell'\n[[light]]\nname = 'all'\n"
                            "[[light]]\nposition = [0, 1, 0]\nintensity = 1\n")
                           .lights),
              testing::ElementsAre("ceiling", "light1"));
}

TEST_F(Shot, RefusesSeveralLightsThatCannotBe) {
  const std::string scene = "scene = 'cornell'\n";
  expect_error(scene + "[[light]]\nname = 'ceiling'\n[[light]]\nname = '0'\n",
               "line 5, light.name: the light 'ceiling' is chosen twice");
  expect_error(scene + "[[light]]\nname = 'ceiling'\n[[light]]\nintensity = 1\n",
               "the light 'ceiling' is chosen twice");
  expect_error(scene + "[[light]]\nname = 'ceiling'\n[[light]]\nposition = [0, 1, 0]\n",
               "line 5, light.position: it needs intensity");
  expect_error(scene + "[[light]]\nposition = [0, 1, 0]\ntowards = [0, 1, 0]\n",
               "line 3, light.position: towards contradicts it");
  expect_error(scene + "[[light]]\nfov = 30\n", "line 3: there is no key 'fov' in [[light]]");
  expect_error(scene + "[[light]]\n[sun]\n", "line 3, sun: [light] contradicts it");
  expect_error(scene + "[[sun]]\n", "sun: it must be a table, begun by [sun]");
  expect_error(scene + "light = [1, 2]\n", "line 2, light: it must be tables, each begun by [[light]]");
}

TEST_F(Shot, MakesALampASpotWhateverComesFirst) {
  const std::string scene = "scene = 'cornell'\n[light]\n";
  for (const char* keys : {"target = [1, 1, -2]\nposition = [1, 1, 1]\nintensity = 1\n",
                           "position = [1, 1, 1]\nintensity = 1\ntarget = [1, 1, -2]\n"}) {
    const Light light = load(scene + keys).lights.at(0);
    ASSERT_TRUE(light.cone);
    EXPECT_EQ(light.cone->axis, D(0, 0, -1));
    EXPECT_EQ(light.cone->inner, 0.0);
    EXPECT_DOUBLE_EQ(light.cone->outer, std::atan(1.0));
  }
  const Light ceiling = load(scene + "angles = [20, 30]\ntarget = [0, 0, 0]\nrange = 4\n").lights.at(0);
  EXPECT_EQ(ceiling.name, "ceiling");
  EXPECT_EQ(ceiling.cone->axis, D(0, -1, 0));
  EXPECT_DOUBLE_EQ(ceiling.cone->outer, std::atan(1.0) * 2 / 3);
  EXPECT_EQ(ceiling.range, 4.0);

  expect_error(scene + "angles = [20, 30]\n", "line 3, light.angles: the light is no spot");
  expect_error(scene + "target = [0, 0, 0]\nangles = [30, 20]\n",
               "line 4, light.angles: the inner half-angle");
  expect_error(scene + "target = [0, 0, 0]\nangles = 30\n", "line 4, light.angles: it must be two numbers");
  expect_error(scene + "target = [0, 1.85, 0]\n", "light 'ceiling': it is a spot whose axis is no direction");
  expect_error(scene + "range = 0\n", "line 3, light.range: 0 is not positive");
}

TEST_F(Shot, RefusesSunsThatCannotBe) {
  const std::string scene = "scene = 'cornell'\n";
  const std::string sun = scene + "[sun]\nirradiance = 1\n";
  expect_error(scene + "[light]\nname = 'ceiling'\n" + "[sun]\ntowards = [0, 1, 0]\nirradiance = 1\n",
               "line 4, sun: [light] contradicts it");
  expect_error(scene + "[light]\n[sun]\n", "line 3, sun: [light] contradicts it");
  expect_error(sun + "towards = [0, 0, 0]\n", "line 4, sun.towards: it has no length");
  expect_error(sun + "towards = [0, 1]\n", "line 4, sun.towards: it must be three numbers");
  expect_error(sun + "towards = [0, nan, 1]\n", "line 4, sun.towards: nan is not finite");
  expect_error(sun + "angles = [0, 1, 2]\n", "line 4, sun.angles: it must be two numbers");
  expect_error(sun + "angles = 30\n", "line 4, sun.angles: it must be two numbers");
  expect_error(sun + "angles = [0, 91]\n", "line 4, sun.angles: the elevation 91 is not between");
  expect_error(sun + "towards = [0, 1, 0]\nangles = [0, 90]\n", "line 4, sun.towards: angles contradicts it");
  expect_error(sun, "line 3, sun.irradiance: the light is a lamp");
  expect_error(scene + "[sun]\ntowards = [0, 1, 0]\n", "line 3, sun.towards: it needs irradiance");
  expect_error(scene + "[sun]\nangles = [0, 40]\n", "line 3, sun.angles: it needs irradiance");
  expect_error(sun + "towards = [1, 0, 0]\n[medium]\nfog_top = 2\n", "at or below the horizon");
  expect_error(scene + "[medium]\nfog_top = [2]\n", "line 3, medium.fog_top: it must be a number");
}

TEST_F(Shot, NamesACameraOrALightByItsNumberToo) {
  const Scene scene = load("scene = 'cornell'\n[camera]\nname = '0'\nfov = 50\n[light]\nname = '0'\n");
  EXPECT_EQ(scene.cameras.at(0).name, "front");
  EXPECT_EQ(scene.lights.at(0).name, "ceiling");
  expect_error("scene = 'cornell'\n[light]\nname = '1'\n",
               "line 3, light.name: the scene has no '1'; it has 'ceiling' (0)");
}

TEST_F(Shot, HasALightTextureThatLiesBesideIt) {
  const auto file = write("s.toml", "scene = 'cornell'\n[light]\ntexture = 'lights/lantern.exr'\n");
  const auto reader = [](const std::filesystem::path& name) {
    return LightTexture(name.string(), {1, 1}, {V(1)});
  };
  const Light light = load_shot(file, {}, reader).lights.at(0);
  ASSERT_TRUE(light.texture);
  EXPECT_EQ(light.texture->name(), (folder_ / "lights/lantern.exr").string());
  EXPECT_EQ(light.name, "ceiling");

  const auto failing = [](const std::filesystem::path& name) -> LightTexture {
    throw Error(ExitCode::bad_file, name.string(), "it is dark");
  };
  try {
    load_shot(file, {}, failing);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code, ExitCode::bad_file);
    EXPECT_THAT(error.what(), HasSubstr("s.toml, line 3, light.texture: "));
    EXPECT_THAT(error.what(), HasSubstr("lantern.exr: it is dark"));
  }
  const std::string scene = "scene = 'cornell'\n[light]\n";
  expect_error(scene + "texture = 'lantern.exr'\n", "line 3, light.texture: there is nothing to read");
  expect_error(scene + "texture = 1\n", "line 3, light.texture: it must be a text");
}

TEST_F(Shot, RefusesScenesThatItCannotShow) {
  expect_error("exposure = 1\n", "it names no scene");
  expect_error("scene = 'none.glb'\n", "none.glb: there is no such file");
  expect_error("\nscene = 'models'\n", "line 2, scene: ");
  write("other.toml", "scene = 'cornell'");
  expect_error("scene = 'other.toml'\n", "line 1, scene: ");
  expect_error("scene = 'a shot.toml'\n", ".toml files cannot be read");
  write("models/bad.obj", "v 0 0 nan\n");
  expect_error("scene = 'models/bad.obj'\n", "bad.obj, line 1");
  EXPECT_THROW(load_shot(folder_ / "none.toml"), Error);
}

TEST_F(Shot, RefusesWhatIsNoToml) {
  expect_error("scene = 'cornell'\nexposure = \n", "line 2: ");
  expect_error("scene = 'cornell'\nscene = 'window'\n", "line 2: ");
  expect_error("scene = 'cornell'\n[camera\n", "line 2: ");
  expect_error(std::string("\x7f\x45\x4c\x46\0\1", 6), "line 1: ");
  expect_error("a = " + std::string(100'000, '['), "line 1: ");
}

TEST(ShotsOfTheProject, Load) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_ASSETS)) {
    if (entry.path().extension() != ".toml") continue;
    const Scene scene = load_shot(entry.path());
    EXPECT_FALSE(scene.geometry.triangles.empty()) << entry.path();
    EXPECT_FALSE(scene.lights.empty()) << entry.path();
    EXPECT_TRUE(scene.exposure.has_value()) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace airlight::scene
