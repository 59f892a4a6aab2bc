#include "scene/view_fields.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"
#include "support/paths.h"

namespace airlight::scene {
namespace {

using testing::HasSubstr;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

LightTexture white(const std::filesystem::path& file) {
  return {file.string(), {1, 1}, {glm::vec3(1.0f)}};
}

/// Things that have every field.
template <typename Thing>
Thing complete() {
  return {};
}
template <>
Light complete() {
  return {.name = "", .cone = Cone{}};
}
template <>
Medium complete() {
  return {.phase = PhaseFunction::hoffman_preetham};
}
template <>
Scene complete() {
  Scene scene;
  scene.geometry.materials = {{}};
  return scene;
}

/// One that has the field.
template <typename Thing>
Thing owner_of(const Field<Thing>& field) {
  auto thing = complete<Thing>();
  if constexpr (std::is_same_v<Thing, Light>)
    if (field.lack && field.lack(thing)) thing.kind = LightKind::sun;
  return thing;
}

/// A text of that kind which is inside every field's range, and no field's default.
std::string text_for(const FieldInfo& field) {
  // Of a spot at the origin a point of its axis is kept, 1 m from it.
  if (field.name == "spot-target") return "0,0,-1";
  switch (field.kind) {
    case FieldKind::number:
      return "0.7";
    case FieldKind::vector:
      return "-0.1,0.3333333333333333,7e-09";
    case FieldKind::direction:
      return "0,0,-1";
    case FieldKind::angles:
      return "30,45";
    case FieldKind::cone:
      return "12.3,30";
    case FieldKind::colour:
      return "0.1,0.33333334,1e-09";
    case FieldKind::word:
      return std::string(field.words[field.words.size() - 2]);
    case FieldKind::file:
      return "a lantern.exr";
    case FieldKind::size:
      return "640x480";
  }
  return {};
}

template <typename Thing>
class FieldsOf : public testing::Test {};
using Things = testing::Types<Camera, Light, Medium, Surroundings, Scene, View>;
TYPED_TEST_SUITE(FieldsOf, Things);

TYPED_TEST(FieldsOf, ReadBackTheTextThatTheyWereSetTo) {
  for (const Field<TypeParam>& field : fields<TypeParam>()) {
    auto thing = owner_of(field);
    const std::string text = text_for(field);
    const FieldValue value = value_of_text(field, "", text, white);
    EXPECT_EQ(text_of(value), text) << field.name;
    const auto before = field.get(thing);
    EXPECT_TRUE(!before || text_of(*before) != text) << field.name;
    ASSERT_FALSE(field.set(thing, value)) << field.name;
    ASSERT_TRUE(field.get(thing)) << field.name;
    EXPECT_EQ(*field.get(thing), value) << field.name;
  }
}

TYPED_TEST(FieldsOf, RefuseWhatIsNotFiniteAndStayAsTheyAre) {
  for (const Field<TypeParam>& field : fields<TypeParam>()) {
    auto thing = owner_of(field);
    const auto before = field.get(thing);
    for (double bad : {k_nan, k_infinity, -k_infinity}) {
      std::vector<FieldValue> values;
      if (field.kind == FieldKind::number) values = {bad};
      if (field.kind == FieldKind::vector || field.kind == FieldKind::direction ||
          field.kind == FieldKind::colour)
        values = {glm::dvec3(bad, 0, 0), glm::dvec3(0, bad, 0), glm::dvec3(0, 0, bad)};
      for (const FieldValue& value : values) {
        const auto wrong = field.set(thing, value);
        ASSERT_TRUE(wrong) << field.name;
        EXPECT_THAT(wrong->problem, HasSubstr(bad > 0 ? "inf is not finite" : " is not finite"))
            << field.name;
      }
    }
    EXPECT_EQ(field.get(thing), before) << field.name;
  }
}

TYPED_TEST(FieldsOf, SayWhatTheyAre) {
  for (const Field<TypeParam>& field : fields<TypeParam>()) {
    EXPECT_NE(field.placeholder, "") << field.name;
    EXPECT_NE(field.label, "") << field.name;
    EXPECT_NE(field.meaning, "") << field.name;
    EXPECT_THAT(field.help(), HasSubstr(std::string(field.meaning)));
    EXPECT_THAT(field.help(), HasSubstr(std::string(field.unit)));
    EXPECT_THAT(field.help(), HasSubstr(std::string(field.usual)));
  }
}

/// What is wrong with a text for a field; empty for nothing.
template <typename Thing>
std::string problem(std::string_view name, std::string_view text) {
  const FieldInfo& info = field<Thing>(name);
  const auto wrong = info.problem(value_of_text(info, "", text, white));
  return wrong ? wrong->problem : "";
}

TEST(Fields, RefuseWhatIsOutOfRange) {
  for (const char* name : {"eye", "target"})
    EXPECT_EQ(problem<Camera>(name, "0,-2e18,0"), "it is farther than 1e+18 m from the origin");
  EXPECT_EQ(problem<Light>("light-position", "2e18,0,0"), "it is farther than 1e+18 m from the origin");
  EXPECT_EQ(problem<Camera>("up", "0,2e18,0"), "");
  for (const char* text : {"0", "-1", "180", "1e+39"})
    EXPECT_EQ(problem<Camera>("fov", text), fmt::format("{} is not between 0 and 180 degrees", text));
}

TEST(Fields, RefuseColoursThatCannotBe) {
  const auto problems = [](std::string_view text) {
    return std::vector{problem<Light>("intensity", text), problem<Medium>("sigma-s", text),
                       problem<Medium>("sigma-a", text), problem<Scene>("albedo", text)};
  };
  EXPECT_THAT(problems("0,0,-1e-9"), testing::Each("it must not be negative"));
  EXPECT_THAT(problems("0,1e39,0"), testing::Each("it is too large"));
  EXPECT_THAT(problems("1,0,1"), testing::Each(""));
  EXPECT_EQ(problem<Scene>("albedo", "0,1.1,0"), "it is more than 1");
  EXPECT_EQ(problem<Medium>("sigma-s", "1e6"), "");
  EXPECT_EQ(problem<Medium>("sigma-s", "3e38"), "it is more than 1e+06 1/m");
  EXPECT_EQ(problem<Light>("intensity", "1e30"), "");
  EXPECT_EQ(problem<Light>("intensity", "1e31"), "it is more than 1e+30 W/sr");
}

TEST(Fields, RefuseNumbersThatSinglePrecisionRoundsOutOfTheirRange) {
  for (const char* text : {"1", "-1", "0.99999999999", "2"})
    EXPECT_EQ(problem<Medium>("g", text), fmt::format("{} is not between -1 and 1", text));
  EXPECT_EQ(problem<Medium>("g", "-0.999999"), "");
  for (const char* text : {"-0.1", "1.1"})
    EXPECT_EQ(problem<Medium>("rayleigh-weight", text), fmt::format("{} is not between 0 and 1", text));
  EXPECT_EQ(problem<Medium>("rayleigh-weight", "0") + problem<Medium>("rayleigh-weight", "1"), "");
  for (const char* text : {"0", "-1", "1e-60"})
    EXPECT_EQ(problem<Scene>("exposure", text), fmt::format("{} is not positive", text));
  EXPECT_EQ(problem<Scene>("exposure", "1e39"), "it is too large");
}

TEST(Fields, RefuseWordsAndSizesThatAreNone) {
  EXPECT_EQ(problem<Medium>("phase", "mie"), "'mie' is unknown");
  EXPECT_EQ(field<Medium>("phase").problem(std::string("mie"))->remedy,
            "use isotropic, rayleigh, henyey-greenstein or hoffman-preetham");
  for (const char* text : {"0x5", "5x0", "-5x5"})
    EXPECT_EQ(problem<View>("size", text), fmt::format("an image of {} has no pixels", text));
}

TEST(Fields, AreNoneWhereAThingHasNone) {
  const auto& g = field<Medium>("g");
  const auto& weight = field<Medium>("rayleigh-weight");
  for (std::string_view name : phase_names()) {
    Medium medium;
    ASSERT_FALSE(field<Medium>("phase").set(medium, std::string(name)));
    EXPECT_EQ(g.get(medium).has_value(), has_g(medium.phase)) << name;
    EXPECT_EQ(g.set(medium, 0.5).has_value(), !has_g(medium.phase)) << name;
    EXPECT_EQ(medium.g, has_g(medium.phase) ? 0.5f : 0.0f);
    EXPECT_EQ(weight.get(medium).has_value(), name == "hoffman-preetham");
    EXPECT_EQ(weight.set(medium, 0.25).has_value(), name != "hoffman-preetham");
  }
  EXPECT_FALSE(field<Light>("light-texture").get({}));
  EXPECT_FALSE(field<Medium>("fog-top").get({}));
  EXPECT_FALSE(field<Scene>("exposure").get({}));
  Scene scene;
  scene.geometry.materials = {{}, {}};
  EXPECT_FALSE(field<Scene>("albedo").get(scene));
}

TEST(Fields, OfALampAndOfASunExcludeOneAnother) {
  const std::set<std::string_view> of_sun = {"sun", "irradiance"};
  for (const Field<Light>& field : fields<Light>()) {
    Light lamp = complete<Light>(), sun = scene::sun("", {0, 1, 0}, glm::vec3(1.0f));
    const FieldValue value = value_of_text(field, "", text_for(field), white);
    EXPECT_EQ(field.set(lamp, value).has_value(), of_sun.contains(field.name)) << field.name;
    EXPECT_EQ(field.set(sun, value).has_value(), !of_sun.contains(field.name)) << field.name;
    EXPECT_EQ(field.get(lamp).has_value(), !of_sun.contains(field.name)) << field.name;
    EXPECT_EQ(field.get(sun).has_value(), of_sun.contains(field.name)) << field.name;
  }
  const Light sun = scene::sun("", {0, 1, 0}, glm::vec3(1.0f));
  EXPECT_EQ(field<Light>("intensity").lack(sun)->problem, "the light is a sun, which has no intensity");
  EXPECT_EQ(field<Light>("irradiance").lack({})->problem, "the light is a lamp, which has no irradiance");
  EXPECT_EQ(field<Light>("light-texture").lack(sun)->remedy, "textured lights are lamps");
}

TEST(Fields, OfASunKeepItsDirectionWhateverItsLength) {
  for (double length : {1e-300, 1e-3, 1.0, 7.0, 1e300}) {
    Light sun = scene::sun("", {0, 1, 0}, glm::vec3(1.0f));
    ASSERT_FALSE(field<Light>("sun").set(sun, length * glm::dvec3(0.0, 0.6, -0.8)));
    EXPECT_NEAR(glm::distance(sun.towards, glm::dvec3(0.0, 0.6, -0.8)), 0.0, 1e-15) << length;
  }
  EXPECT_EQ(problem<Light>("sun", "0,0,0"), "it has no length, and so no direction");
  EXPECT_EQ(problem<Light>("irradiance", "1e26"), "it is more than 1e+25 W/m2");
}

TEST(Fields, AnglesOfASunAreItsAzimuthFromZTowardsXAndItsElevation) {
  const auto expect = [](glm::dvec2 angles, glm::dvec3 direction) {
    EXPECT_NEAR(glm::distance(direction_of_angles(angles), direction), 0.0, 1e-15);
  };
  expect({0, 0}, {0, 0, 1});
  expect({90, 0}, {1, 0, 0});
  expect({-90, 0}, {-1, 0, 0});
  expect({123, 90}, {0, 1, 0});
  expect({180, 30}, {0, 0.5, -std::sqrt(0.75)});
  expect({90, -30}, {std::sqrt(0.75), -0.5, 0});
  EXPECT_EQ(sun_angles().problem(glm::dvec2(1e4, -90)), std::nullopt);
  EXPECT_EQ(sun_angles().problem(glm::dvec2(0, 91))->problem,
            "the elevation 91 is not between -90 and 90 degrees");
  for (double bad : {k_nan, k_infinity}) {
    EXPECT_TRUE(sun_angles().problem(glm::dvec2(bad, 0)));
    EXPECT_TRUE(sun_angles().problem(glm::dvec2(0, bad)));
  }
}

TEST(Fields, OfASpotAimItFromWhereItStands) {
  for (double scale : {1e-9, 1.0, 1e9}) {
    Light lamp = point_light("", scale * glm::dvec3(1, 2, 3), glm::vec3(1.0f));
    const glm::dvec3 axis(0.6, 0.0, -0.8);
    ASSERT_FALSE(field<Light>("spot-target").set(lamp, lamp.position + 5.0 * scale * axis));
    ASSERT_TRUE(lamp.cone);
    EXPECT_NEAR(glm::distance(lamp.cone->axis, axis), 0.0, 1e-15);
    EXPECT_EQ(lamp.cone->inner, 0.0);
    EXPECT_EQ(*field<Light>("spot-angles").get(lamp), FieldValue(glm::dvec2(0, 45)));
    // What is read aims another lamp there alike.
    Light other = lamp;
    other.cone.reset();
    ASSERT_FALSE(field<Light>("spot-target").set(other, *field<Light>("spot-target").get(lamp)));
    EXPECT_NEAR(glm::distance(other.cone->axis, axis), 0.0, 1e-15);
  }
}

TEST(Fields, OfASpotRefuseHalfAnglesThatAreNone) {
  for (const char* text : {"0,45", "30,30", "90,90", "0,1e-3"})
    EXPECT_EQ(problem<Light>("spot-angles", text), "");
  EXPECT_EQ(problem<Light>("spot-angles", "30,20"), "the inner half-angle 30 is more than the outer one, 20");
  EXPECT_EQ(problem<Light>("spot-angles", "0,0"), "a cone of half-angle 0 lets no light through");
  EXPECT_EQ(problem<Light>("spot-angles", "0,91"), "the half-angle 91 is not between 0 and 90 degrees");
  EXPECT_EQ(problem<Light>("spot-angles", "-1,45"), "the half-angle -1 is not between 0 and 90 degrees");
  for (double bad : {k_nan, k_infinity}) {
    EXPECT_TRUE(field<Light>("spot-angles").problem(glm::dvec2(bad, 45)));
    EXPECT_TRUE(field<Light>("spot-angles").problem(glm::dvec2(0, bad)));
  }
  EXPECT_EQ(field<Light>("spot-angles").lack({})->problem, "the light is no spot, which alone has a cone");
  for (const char* text : {"0", "-2"})
    EXPECT_EQ(problem<Light>("range", text), fmt::format("{} is not positive", text));
}

TEST(Fields, OfAPhaseFunctionWithoutGForgetIt) {
  Medium medium = {.phase = PhaseFunction::henyey_greenstein, .g = 0.5f};
  ASSERT_FALSE(field<Medium>("phase").set(medium, std::string("rayleigh")));
  EXPECT_EQ(medium.g, 0.0f);
}

TEST(Fields, HaveKeysThatFollowFromTheirNames) {
  EXPECT_EQ(field<Light>("light-position").key(), "position");
  EXPECT_EQ(field<Light>("intensity").key(), "intensity");
  EXPECT_EQ(field<Light>("spot-target").key(), "target");
  EXPECT_EQ(field<Light>("spot-angles").key(), "angles");
  EXPECT_EQ(field<Light>("range").key(), "range");
  EXPECT_EQ(field<Medium>("rayleigh-weight").key(), "rayleigh_weight");
  EXPECT_EQ(field<View>("size").key(), "size");
  EXPECT_EQ(field<Light>("sun").key(), "towards");
  EXPECT_EQ(sun_angles().key(), "angles");
  EXPECT_EQ(field<Medium>("fog-top").key(), "fog_top");
  EXPECT_EQ(camera_choice().key(), "name");
  std::set<std::string> names, keys;
  for (const FieldInfo* info : every_field()) {
    EXPECT_TRUE(names.emplace(info->name).second) << info->name;
    EXPECT_TRUE(keys.insert(fmt::format("{}.{}", info->group, info->key())).second) << info->name;
  }
}

TEST(Fields, AreInTheDocumentationOfShots) {
  std::ifstream stream(AIRLIGHT_SHOT_HEADER);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const FieldInfo* info : every_field()) {
    if (info->name == "size") continue;
    // Between the head of its table and the next.
    const std::size_t begin = info->group.empty() ? 0 : text.find(fmt::format("///     [{}]", info->group));
    ASSERT_NE(begin, text.npos) << info->group;
    const std::string table = text.substr(begin, text.find("///     [", begin + 1) - begin);
    EXPECT_THAT(table, HasSubstr(fmt::format(" {} = ", info->key())));
  }
}

}  // namespace
}  // namespace airlight::scene
