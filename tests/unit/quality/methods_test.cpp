#include "quality/methods.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "media/march.h"
#include "media/vsv.h"
#include "scene/error.h"
#include "support/cut_outs.h"
#include "support/paths.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;
using testing::HasSubstr;

/// What parsing a list of volume methods complains about.
std::string complaint(std::string_view list) {
  try {
    parse_volumes(list);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code, ExitCode::usage);
    return error.what();
  }
  return "none";
}

const media::VsvOptions& vsv_of(const VolumeChoice& choice) {
  return std::any_cast<const media::VsvOptions&>(choice.options);
}

TEST(MethodSpec, OfOneWordTakesTheCommonOptions) {
  const std::vector<CommonOption> common = {{"--alpha", "alpha", "100"},
                                            {"--integral", "integral", "riemann"}};
  const std::vector<VolumeChoice> choices = parse_volumes("vsv", common);
  ASSERT_EQ(choices.size(), 1u);
  EXPECT_EQ(choices[0].spec, "vsv");
  EXPECT_EQ(choices[0].method->name, "vsv");
  EXPECT_EQ(vsv_of(choices[0]).volume.resolution.alpha, 100);
  EXPECT_EQ(vsv_of(choices[0]).integral, media::VsvIntegral::riemann);
}

TEST(MethodSpec, OwnKeysOverrideTheCommonOptions) {
  const std::vector<CommonOption> common = {
      {"--alpha", "alpha", "100"}, {"--theta", "theta", "200"}, {"--phi", "phi", "256"}};
  const std::vector<VolumeChoice> choices = parse_volumes(
      "vsv:alpha=7:phi=128,vsv:integral=riemann:scan=column:phi-cells=equal:populate=conservative,"
      "reference-sampled:samples=33,reference-march:steps=44:rays=single,none,"
      "march:steps=9:spacing=angle:jitter=gathered:look-up=rows:theta=77",
      common);
  ASSERT_EQ(choices.size(), 6u);
  EXPECT_EQ(vsv_of(choices[0]).volume.resolution, (epipolar::Resolution{7, 200, 128}));
  const media::VsvOptions& second = vsv_of(choices[1]);
  EXPECT_EQ(second.volume.resolution, (epipolar::Resolution{100, 200, 256}));
  EXPECT_EQ(second.integral, media::VsvIntegral::riemann);
  EXPECT_EQ(second.volume.scan, epipolar::Scan::column);
  EXPECT_EQ(second.volume.populate, epipolar::Populate::conservative);
  EXPECT_EQ(second.phi_cells, media::PhiCells::equal);
  EXPECT_EQ(choices[2].values().at("samples"), frame::OptionValue(33));
  EXPECT_EQ(choices[3].values().at("steps"), frame::OptionValue(44));
  EXPECT_EQ(choices[3].values().at("rays"), frame::OptionValue("single"));
  EXPECT_EQ(choices[4].method->name, "none");
  EXPECT_TRUE(choices[4].values().empty());
  const auto& march = std::any_cast<const media::MarchOptions&>(choices[5].options);
  EXPECT_EQ(march.steps, 9);
  EXPECT_EQ(march.spacing, media::MarchSpacing::angle);
  EXPECT_EQ(march.jitter, media::MarchJitter::gathered);
  EXPECT_EQ(march.look_up, media::MarchLookUp::rows);
  EXPECT_EQ(march.volume.resolution.theta, 77);
}

TEST(MethodSpec, MistakesAreNamedWithWhatIsValid) {
  EXPECT_THAT(complaint("fog"), testing::AllOf(HasSubstr("'fog'"), HasSubstr("reference-march")));
  EXPECT_THAT(complaint(""), HasSubstr("''"));
  EXPECT_THAT(complaint("vsv,"), HasSubstr("''"));
  EXPECT_THAT(complaint("vsv:"), HasSubstr("no key ''"));
  EXPECT_THAT(complaint("vsv:steps=3"), testing::AllOf(HasSubstr("'steps'"), HasSubstr("integral")));
  EXPECT_THAT(complaint("vsv:alpha"), testing::AllOf(HasSubstr("no value"), HasSubstr("131072")));
  EXPECT_THAT(complaint("vsv:alpha="), HasSubstr("''"));
  EXPECT_THAT(complaint("vsv:alpha=-4"), testing::AllOf(HasSubstr("vsv:alpha=-4"), HasSubstr("'-4'")));
  EXPECT_THAT(complaint("vsv:alpha=4x"), HasSubstr("'4x'"));
  EXPECT_THAT(complaint("vsv:alpha=99999999999"), HasSubstr("'99999999999'"));
  EXPECT_THAT(complaint("vsv:phi=100"), HasSubstr("multiple of 128"));
  EXPECT_THAT(complaint("vsv:phi=0"), HasSubstr("multiple of 128"));
  EXPECT_THAT(complaint("vsv:theta=many"), HasSubstr("theta"));
  EXPECT_THAT(complaint("reference-sampled:samples=auto"), HasSubstr("'auto'"));
  EXPECT_THAT(complaint("vsv:populate=screen-space:scan=fused"), HasSubstr("column"));
  EXPECT_THAT(complaint("vsv:populate=screen-space:scan=blocks"),
              testing::AllOf(HasSubstr("scan=blocks"), HasSubstr("column")));
  EXPECT_THAT(complaint("vsv:scan=blocks:alpha=65537"),
              testing::AllOf(HasSubstr("alpha=65537"), HasSubstr("65536")));
  EXPECT_THAT(complaint("vsv:integral=sum"), testing::AllOf(HasSubstr("unknown"), HasSubstr("riemann")));
  EXPECT_THAT(complaint("none:alpha=4"), HasSubstr("it has none"));
  EXPECT_THAT(complaint("march:steps=7"), testing::AllOf(HasSubstr("march:steps=7, steps"), HasSubstr("8")));
  EXPECT_THAT(complaint("march:steps=513"), HasSubstr("512"));
  EXPECT_THAT(complaint("march:spacing=phi"), testing::AllOf(HasSubstr("distance"), HasSubstr("angle")));
  EXPECT_THAT(complaint("froxel:tile=0"), HasSubstr("between 1 and 64"));
  EXPECT_THAT(complaint("froxel:slices=7"),
              testing::AllOf(HasSubstr("slices=7"), HasSubstr("between 8 and 512")));
  EXPECT_THAT(complaint("froxel:samples=many"), HasSubstr("samples"));
  EXPECT_THAT(complaint("march:jitter=on"), testing::AllOf(HasSubstr("interleaved"), HasSubstr("gathered")));
  EXPECT_THAT(complaint("vsv,vsv"), HasSubstr("twice"));
}

TEST(MethodSpec, OfSurfacesHasItsOwnMethods) {
  EXPECT_EQ(parse_surfaces("none,shadow-map,vsv:theta=64,reference").size(), 4u);
  EXPECT_THROW(parse_surfaces("reference-march"), Error);
  EXPECT_THROW(parse_surfaces("vsv:integral=table"), Error);
}

TEST(MethodSpec, ACommonOptionIsCheckedEvenWhereNoMethodReadsIt) {
  EXPECT_THROW(require_valid({"--alpha", "alpha", "0"}), Error);
  EXPECT_NO_THROW(require_valid({"--alpha", "alpha", "auto"}));
}

template <typename MethodType>
class Registry : public testing::Test {};

struct Volumes {
  static auto methods() { return volume_methods(); }
};
struct Surfaces {
  static auto methods() { return surface_methods(); }
};
using Registries = testing::Types<Volumes, Surfaces>;
TYPED_TEST_SUITE(Registry, Registries);

TYPED_TEST(Registry, EveryValueOfEveryOptionReadsBackAsItWasSet) {
  for (const auto& method : TypeParam::methods()) {
    for (const frame::Option& option : method.options) {
      std::vector<std::string> values;
      if (const auto* words = std::get_if<frame::Words>(&option.values)) {
        for (const frame::Word& word : *words) values.emplace_back(word.word);
      } else {
        const auto& counts = std::get<frame::Counts>(option.values);
        values = {std::to_string(counts.least), std::to_string(counts.most)};
        if (!counts.automatic.empty()) values.emplace_back("auto");
      }
      for (const std::string_view value : option.text.sweep) values.emplace_back(value);
      for (const std::string& value : values) {
        std::any options = method.defaults;
        option.set(method.address(options), "here", value);
        EXPECT_EQ(frame::text_of(option.get(method.const_address(options))), value)
            << method.name << ", " << option.text.name;
      }
    }
  }
}

TYPED_TEST(Registry, DescribesEveryMethodAndOptionOnce) {
  std::vector<std::string_view> names;
  for (const auto& method : TypeParam::methods()) {
    names.push_back(method.name);
    EXPECT_FALSE(method.description.empty()) << method.name;
    EXPECT_EQ(method.name.find_first_of(":=, +"), std::string_view::npos) << method.name;
    std::vector<std::string_view> options;
    for (const frame::Option& option : method.options) {
      options.push_back(option.text.name);
      EXPECT_FALSE(option.text.meaning.empty() || option.text.quality.empty() || option.text.cost.empty())
          << method.name << ", " << option.text.name;
    }
    std::sort(options.begin(), options.end());
    EXPECT_EQ(std::adjacent_find(options.begin(), options.end()), options.end()) << method.name;
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

/// Compares what stands in a file between two marks. With AIRLIGHT_UPDATE set, writes it there instead.
void expect_section(const std::filesystem::path& file, const std::string& begin, const std::string& end,
                    const std::string& expected) {
  std::stringstream stream;
  stream << std::ifstream(file).rdbuf();
  std::string text = stream.str();
  const std::size_t start = text.find(begin) + begin.size(), length = text.find(end, start) - start;
  ASSERT_LT(length, text.size()) << file << " lacks " << begin;
  if (std::getenv("AIRLIGHT_UPDATE")) {
    std::ofstream(file) << text.replace(start, length, expected);
    return;
  }
  EXPECT_EQ(text.substr(start, length), expected)
      << "AIRLIGHT_UPDATE=1 ./test -R unit/quality brings " << file << " up to date";
}

TEST(MethodTables, OfTheReadmeAreTheMethodsOwn) {
  expect_section(AIRLIGHT_README, "a test compares. -->\n\n", "\n<!-- end of the tables -->",
                 method_tables());
}

/// The options of methods as the schema has them, a line each; those that have one name share it.
std::string schema_of(const auto& methods) {
  std::vector<std::pair<std::string, nlohmann::ordered_json>> properties;
  for (const auto& method : methods) {
    for (const frame::Option& option : method.options) {
      const std::string told = fmt::format("{}: {}.", method.name, option.text.meaning);
      nlohmann::ordered_json property = {{"description", told}};
      if (const auto* words = std::get_if<frame::Words>(&option.values)) {
        property["type"] = "string";
        for (const frame::Word& word : *words) property["enum"].push_back(word.word);
      } else {
        property["type"] = "integer";
        property["minimum"] = std::get<frame::Counts>(option.values).least;
      }
      const auto same = std::find_if(properties.begin(), properties.end(),
                                     [&](const auto& other) { return other.first == option.text.name; });
      if (same == properties.end()) {
        properties.emplace_back(option.text.name, property);
        continue;
      }
      nlohmann::ordered_json& shared = same->second;
      EXPECT_EQ(shared["type"], property["type"])
          << option.text.name << " is a count of one method, of another not";
      shared["description"] = shared["description"].template get<std::string>() + " " + told;
      if (property.contains("minimum"))
        shared["minimum"] =
            std::min(shared["minimum"].template get<int>(), property["minimum"].template get<int>());
      for (const auto& word : property.value("enum", nlohmann::ordered_json::array()))
        if (std::find(shared["enum"].begin(), shared["enum"].end(), word) == shared["enum"].end())
          shared["enum"].push_back(word);
    }
  }
  std::string text;
  for (const auto& [name, property] : properties)
    text += fmt::format("{}{:14}\"{}\": {}", text.empty() ? "" : ",\n", "", name, property.dump());
  return text;
}

TEST(ResultsSchema, KnowsTheOptionsOfTheMethods) {
  const auto expect_part = [](const std::string& of, const std::string& expected) {
    expect_section(AIRLIGHT_SCHEMA,
                   "What its " + of +
                       " method was told; each method has some of these.\",\n"
                       "            \"additionalProperties\": false,\n"
                       "            \"required\": [],\n"
                       "            \"properties\": {\n",
                   "\n            }\n", expected);
  };
  expect_part("volume", schema_of(volume_methods()));
  expect_part("surface", schema_of(surface_methods()));
}

scene::Geometry open_triangle() {
  scene::Geometry geometry;
  geometry.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  geometry.triangles = {{0, 1, 2}};
  geometry.material_of_triangle = {0};
  geometry.materials = {{}};
  return geometry;
}

TEST(MethodChoice, FitsAutomaticCountsToTheViewAndItsLights) {
  scene::View view;
  view.camera = {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  view.lights = {scene::point_light("", {0.1, 0.2, 0.0}, glm::vec3(1.0f))};
  const auto fitted = [&](const char* spec) {
    VolumeChoice choice = parse_volumes(spec)[0];
    choice.fit(view);
    return vsv_of(choice).volume.resolution;
  };
  EXPECT_EQ(fitted("vsv"), (epipolar::Resolution{256, 1024, 512}));
  const epipolar::Resolution in_view = fitted("vsv:alpha=auto:theta=auto:phi=auto");
  EXPECT_EQ(in_view.phi, 512);
  EXPECT_GT(in_view.theta, 512);
  view.lights = {scene::point_light("", {9, 0, 0}, glm::vec3(1.0f))};
  const epipolar::Resolution aside = fitted("vsv:alpha=auto:theta=auto");
  EXPECT_NE(aside, in_view);
  view.lights.push_back(scene::point_light("", {0.1, 0.2, 0.0}, glm::vec3(1.0f)));
  const epipolar::Resolution both = fitted("vsv:alpha=auto:theta=auto");
  EXPECT_EQ(both.alpha, std::max(aside.alpha, in_view.alpha));
  EXPECT_EQ(both.theta, std::max(aside.theta, in_view.theta));
}

TEST(MethodChoice, ThatTakesPartsForSolidsWarnsOfOpenOnes) {
  scene::Scene scene;
  scene.geometry = open_triangle();
  const auto surfaces = parse_surfaces("shadow-map");
  warn_of_geometry(parse_volumes("vsv"), surfaces, scene);
  EXPECT_TRUE(scene.report.warnings.empty());
  warn_of_geometry(parse_volumes("vsv:populate=screen-space"), surfaces, scene);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_THAT(scene.report.warnings[0],
              testing::AllOf(HasSubstr("vsv:populate=screen-space"), HasSubstr("3 edges with one triangle")));
}

TEST(MethodChoice, ThatTakesTrianglesWholeWarnsOfCutOuts) {
  scene::Scene scene;
  scene.geometry = tests::half_cut_away();
  warn_of_geometry(parse_volumes("vsv,march,froxel,reference"), parse_surfaces("shadow-map,vsv,reference"),
                   scene);
  EXPECT_TRUE(scene.report.warnings.empty());
  warn_of_geometry(parse_volumes("vsv:populate=conservative"), parse_surfaces("psv,brute,metric-tree"), scene);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_THAT(scene.report.warnings[0], HasSubstr("vsv:populate=conservative, psv, brute, metric-tree cannot show"));
}

TEST(SharedReference, TracesTheTruthOnceAndChargesForItTwice) {
  const scene::Geometry geometry = open_triangle();
  scene::View view;
  view.camera = {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  view.lights[0].position = {1, 2, 3};
  view.size = {8, 8};
  SharedReference shared(geometry, view, {});

  const reference::AirlightImage* image = &shared.exact(0, 1);
  const SharedReference::Work first = shared.take_work();
  EXPECT_GT(first.airlight_ms, 0.0);
  EXPECT_EQ(first.kept_ms_of("integrate"), 0.0);
  EXPECT_EQ(&shared.exact(0, 1), image);
  const SharedReference::Work second = shared.take_work();
  EXPECT_EQ(second.airlight_ms, first.airlight_ms);
  EXPECT_EQ(second.kept_ms_of("integrate"), first.airlight_ms);
  EXPECT_NE(&shared.exact(0, 2), image);
  EXPECT_EQ(shared.take_work().kept_ms_of("integrate"), 0.0);
}

TEST(SharedReference, JudgesPointsAnewUnlessTheyAreThoseOfTheLastTime) {
  const scene::Geometry geometry = open_triangle();
  scene::View view;
  view.camera = {"", {0.2, 0.2, 5}, {0.2, 0.2, 0}, {0, 1, 0}, 45};
  view.lights[0].position = {0.25, 0.25, 3};
  view.size = {2, 1};
  SharedReference shared(geometry, view, {});
  // The first pixel shows the triangle, whose plane is z = 0; the second nothing.
  frame::SurfacePoints points{.triangles = {1, 0}, .of_light = {{{0, 0, -3, 1}, {0, 0, 0, -1}}}};
  const SurfaceVerdicts verdicts = shared.verdicts(0, points);
  ASSERT_EQ(verdicts.size(), 2u);
  EXPECT_EQ(verdicts[0], (reference::SurfaceVerdict{reference::Verdict::lit, true}));
  EXPECT_FALSE(verdicts[1]);
  EXPECT_EQ(shared.take_work().kept_ms_of("surface_query"), 0.0);
  EXPECT_EQ(shared.verdicts(0, points), verdicts);
  EXPECT_GT(shared.take_work().kept_ms_of("surface_query"), 0.0) << "charged for what it cost";
  points = {.triangles = {0, 1}, .of_light = {{{0, 0, 0, -1}, {0, 0, -3, 0}}}};
  EXPECT_EQ(shared.verdicts(0, points), (SurfaceVerdicts{verdicts[1], verdicts[0]}))
      << "that the frame takes its plane to part eye and light does not matter";
  EXPECT_EQ(shared.take_work().kept_ms_of("surface_query"), 0.0);
  points.of_light[0][1].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(shared.verdicts(0, points), scene::Error);
}

}  // namespace
}  // namespace airlight::quality
