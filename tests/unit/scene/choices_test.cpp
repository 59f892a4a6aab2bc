#include "scene/choices.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace airlight::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PlainChoices final : public Choices {
 public:
  std::string spell(const FieldInfo& field) const override { return std::string(field.name); }
  Error error(const FieldInfo& field, const std::string& problem, const std::string& remedy) const override {
    return Error(ExitCode::usage, spell(field), problem, remedy);
  }
};

/// The choices of one light, by names of fields and texts.
using Texts = std::vector<std::pair<std::string, std::string>>;

/// The names of a scene's lights once these are chosen.
std::vector<std::string> chosen(const std::vector<std::string>& names, const std::vector<Texts>& lights,
                                Scene& scene) {
  for (const std::string& name : names) scene.lights.push_back(point_light(name, {}, glm::vec3(1.0f)));
  std::vector<std::unique_ptr<const Choices>> choices;
  for (const Texts& texts : lights) {
    auto of_light = std::make_unique<PlainChoices>();
    for (const auto& [name, text] : texts)
      of_light->add(*find_field(name), value_of_text(*find_field(name), name, text, {}));
    choices.push_back(std::move(of_light));
  }
  choose_all(PlainChoices(), choices, scene);
  std::vector<std::string> after;
  for (const Light& light : scene.lights) after.push_back(light.name);
  return after;
}

std::vector<std::string> chosen(const std::vector<std::string>& names,
                                const std::vector<Texts>& lights = {}) {
  Scene scene;
  return chosen(names, lights, scene);
}

std::string refusal(const std::vector<std::string>& names, const std::vector<Texts>& lights) {
  try {
    chosen(names, lights);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

const Texts k_lamp = {{"light-position", "0,1,0"}, {"intensity", "1"}};

TEST(Lights, HaveNamesOfTheirOwn) {
  EXPECT_THAT(chosen({"a", "b"}), ElementsAre("a", "b"));
  EXPECT_THAT(chosen({"", "a", ""}), ElementsAre("light0", "a", "light2"));
  EXPECT_THAT(chosen({"a", "a", "a"}), ElementsAre("a", "a_2", "a_3"));
  EXPECT_THAT(chosen({"a_2", "a", "a"}), ElementsAre("a_2", "a", "a_3"));
  EXPECT_THAT(chosen({"", "light0", "light2"}), ElementsAre("light1", "light0", "light2"));
}

TEST(Lights, AreThoseChosenInTheirOrder) {
  EXPECT_THAT(chosen({"a", "b", "c"}, {{{"light", "c"}}, {{"light", "0"}}}), ElementsAre("c", "a"));
  EXPECT_THAT(chosen({"a", "b"}, {{{"light", "all"}}}), ElementsAre("a", "b"));
  EXPECT_THAT(chosen({"a", "b"}, {k_lamp}), ElementsAre("light0")) << "they stand in for the scene's";
  EXPECT_THAT(chosen({"a", "b"}, {k_lamp, {{"light", "b"}}, k_lamp}), ElementsAre("light0", "b", "light2"));
  EXPECT_THAT(chosen({"a"}, {{{"light", "all"}}, k_lamp}), ElementsAre("a", "light1"));
  EXPECT_THAT(chosen({"", "light0"}, {{{"light", "light1"}}, k_lamp}), ElementsAre("light1", "light2"))
      << "a new one takes no name that is taken";
}

TEST(Lights, ThatAreOffCanBeChosenByName) {
  Scene scene;
  EXPECT_THAT(chosen({"a", "b"}, {k_lamp}, scene), ElementsAre("light0"));
  EXPECT_THAT(chosen({}, {{{"light", "all"}}}, scene), ElementsAre("light0"));
  EXPECT_THAT(chosen({}, {{{"light", "b"}}, {{"light", "light0"}}, k_lamp}, scene),
              ElementsAre("b", "light0", "light2"));
  ASSERT_EQ(scene.other_lights.size(), 1u);
  EXPECT_EQ(scene.other_lights[0].name, "a");
}

TEST(Lights, HaveTheirOwnFields) {
  Scene scene;
  chosen({"a", "b", "c"}, {{{"light", "a"}, {"intensity", "3"}}, {{"light", "b"}}}, scene);
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3.0f));
  EXPECT_EQ(scene.lights[1].intensity, glm::vec3(1.0f));

  Scene all;
  chosen({"a", "b"}, {{{"light", "all"}, {"intensity", "3"}}}, all);
  EXPECT_EQ(all.lights[0].intensity, glm::vec3(3.0f));
  EXPECT_EQ(all.lights[1].intensity, glm::vec3(3.0f));

  Scene only;
  chosen({"a"}, {{{"intensity", "3"}}}, only);
  EXPECT_EQ(only.lights[0].intensity, glm::vec3(3.0f));
}

TEST(Lights, AreRefusedWhereItIsNotSaidWhichAreMeant) {
  EXPECT_THAT(
      refusal({"a", "b"}, {{{"intensity", "3"}}}),
      HasSubstr(
          "intensity: the scene has several lights, 'a' (0), 'b' (1); say which one is meant by light"));
  EXPECT_THAT(refusal({}, {{{"intensity", "3"}}}), HasSubstr("intensity: the scene has no light; place one"));
  EXPECT_THAT(refusal({}, {{{"light", "all"}}}), HasSubstr("light: the scene has no 'all'; it has none"));
  EXPECT_THAT(refusal({"a"}, {{{"light", "b"}}}), HasSubstr("the scene has no 'b'; it has 'a' (0)"));
  EXPECT_THAT(refusal({"a", "b"}, {{{"light", "all"}}, {{"light", "b"}}}),
              HasSubstr("light: the light 'b' is chosen twice"));
}

TEST(Lights, AreNamedByWhatSaysWhichOrWhere) {
  std::vector<std::string_view> naming, others;
  for (const FieldInfo* field : every_field())
    if (is_of_light(*field)) (names_light(*field) ? naming : others).push_back(field->name);
  EXPECT_THAT(naming, ElementsAre("light", "light-position", "sun", "sun-angles"));
  EXPECT_THAT(others, testing::IsSupersetOf({"intensity", "light-texture", "irradiance"}));
  EXPECT_FALSE(is_of_light(*find_field("eye")));
}

}  // namespace
}  // namespace airlight::scene
