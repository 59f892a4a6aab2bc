#include "quality/results.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/error.h"
#include "scene/view_fields.h"

namespace airlight::quality {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Comparison two_runs() {
  Comparison comparison;
  comparison.scene = "hall";
  comparison.truth = {
      .bound = 0.001, .ms = 2.0, .shadows_per_pixel = 40.0, .lit_runs_per_pixel = 3.0, .mean_airlight = 0.5};
  Run vsv;
  vsv.volume = "vsv";
  vsv.surface = "shadow-map";
  vsv.name = "vsv+shadow-map";
  vsv.settings = {{"alpha", 512}, {"integral", std::string("table")}};
  vsv.surface_settings = {{"theta", 64}};
  vsv.debug_images = {{"vsv+shadow-map_grid", "the grid", 0.5f}};
  vsv.cost.stages_ms = {{"scan", 3.0}};
  vsv.cost.frame_ms = 4.0;
  vsv.march_ratio = 5.0;
  vsv.errors.airlight.rrmse = 0.0123;
  vsv.errors.airlight.bias = -0.00042;
  vsv.errors.surface = {.wrong_pixels = 12, .undecided_pixels = 345, .pixels = 7654};
  Run march = vsv;
  march.volume = "reference-march";
  march.cost.stages_ms = {{"integrate", 20.0}};
  march.debug_images = {};
  march.cost.rays = 1'000'000;
  march.cost.mrays_per_s = 50.0;
  march.errors.airlight.rrmse = 0.0005;
  comparison.runs = {vsv, march};
  return comparison;
}

TEST(ResultsJson, KeepsRawFigures) {
  const json results = json::parse(results_json(two_runs()));
  EXPECT_EQ(results["scene"]["name"], "hall");
  EXPECT_EQ(results["reference"]["bound"], 0.001);
  const json& vsv = results["runs"][0];
  EXPECT_EQ(vsv["settings"], (json{{"alpha", 512}, {"integral", "table"}}));
  EXPECT_EQ(vsv["surface_settings"], (json{{"theta", 64}}));
  EXPECT_EQ(vsv["debug_images"],
            json::array({{{"name", "vsv+shadow-map_grid"}, {"caption", "the grid"}, {"white", 0.5}}}));
  EXPECT_FALSE(results["runs"][1].contains("debug_images"));
  EXPECT_EQ(vsv["error"]["airlight"]["rrmse"], 0.0123);
  EXPECT_EQ(vsv["error"]["surface"],
            (json{{"wrong_pixels", 12}, {"undecided_pixels", 345}, {"pixels", 7654}}));
  EXPECT_EQ(vsv["march_ratio"], 5.0);
  EXPECT_FALSE(vsv.contains("rays"));
  EXPECT_EQ(results["runs"][1]["error"]["airlight"]["rrmse"], 0.0005);
  EXPECT_EQ(results["runs"][1]["rays"], 1'000'000);
}

TEST(ResultsJson, WritesSinglePrecisionWithTheDigitsItHas) {
  Comparison comparison = two_runs();
  comparison.view.medium.sigma_s = glm::vec3(0.1f);
  EXPECT_EQ(json::parse(results_json(comparison))["view"]["medium"]["sigma_s"], (json{0.1, 0.1, 0.1}));
}

TEST(ResultsJson, HasNullForWhatIsNoNumberAndSurvivesAnyFileName) {
  Comparison comparison = two_runs();
  comparison.runs[0].errors.airlight.rrmse = std::numeric_limits<double>::quiet_NaN();
  comparison.scene = "\xff.obj";
  const json results = json::parse(results_json(comparison));
  EXPECT_TRUE(results["runs"][0]["error"]["airlight"]["rrmse"].is_null());
}

TEST(ResultsTable, ClaimsNoErrorBelowThatOfTheReference) {
  const std::string table = results_table(two_runs());
  EXPECT_THAT(table, HasSubstr(" 1.23 "));
  EXPECT_THAT(table, HasSubstr("-0.042"));
  EXPECT_THAT(table, HasSubstr("< 0.1 "));
  EXPECT_THAT(table, testing::Not(HasSubstr(" 0.05 ")));
}

TEST(ResultsTable, TellsWrongSurfacesFromUndecidedOnes) {
  const std::string table = results_table(two_runs());
  EXPECT_THAT(table, testing::ContainsRegex("wrong px +undecided px\n"));
  EXPECT_THAT(table, testing::ContainsRegex(" 12 +345\n"));
  EXPECT_THAT(table, HasSubstr("of 7654"));
}

TEST(ErrorText, IsAPercentageOrABound) {
  EXPECT_EQ(error_text(0.02, 0.001), "2");
  EXPECT_EQ(error_text(0.001, 0.001), "< 0.1");
  EXPECT_EQ(error_text(0.0, 0.001), "< 0.1");
  EXPECT_EQ(error_text(0.0, 0.0), "0");
  EXPECT_EQ(error_text(std::numeric_limits<double>::quiet_NaN(), 0.001), "dark");
}

/// A run along three frames, of which all moves before the second and nothing before the third, which is
/// dark.
Comparison along_a_path() {
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  Comparison comparison = two_runs();
  comparison.path = {.seconds = 3.0,
                     .frames = {{.time = 0.0, .motion = scene::Motion::all, .truth = {.mean_airlight = 1.0}},
                                {.time = 1.5, .motion = scene::Motion::all, .truth = {.mean_airlight = 1.0}},
                                {.time = 3.0, .motion = scene::Motion::nothing, .truth = {}}}};
  Run& run = comparison.runs[0];
  run.path.resize(3);
  run.path[0].cost = {.ms = 30.0, .stages_ms = {{"scan", 2.0}}, .redrawn = {"shadow_map", "volume"}};
  run.path[1].cost = {.ms = 20.0, .stages_ms = {{"scan", 2.0}}, .redrawn = {"volume"}};
  run.path[2].cost = {.ms = 10.0, .stages_ms = {}, .redrawn = {}};
  run.path[0].errors.airlight.rrmse = 0.01;
  run.path[1].errors.airlight.rrmse = 0.03;
  run.path[2].errors.airlight.is_dark = true;
  run.path[2].errors.airlight.rrmse = k_none;
  for (Run::Frame& frame : run.path) frame.errors.same_surface.rrmse = k_none;
  run.path[1].errors.surface = {.wrong_pixels = 1, .undecided_pixels = 2, .pixels = 3};
  run.path[1].flicker = 0.02;
  run.path[2].flicker = 0.04;
  run.worst_frame = 1;
  comparison.runs.resize(1);
  return comparison;
}

TEST(Path, HasMeanAndWorstOfWhatIsNotDark) {
  const PathSpreads spreads = path_spreads(along_a_path().runs[0]);
  EXPECT_DOUBLE_EQ(spreads.ms.mean, 20.0);
  EXPECT_DOUBLE_EQ(spreads.ms.worst, 30.0);
  EXPECT_DOUBLE_EQ(spreads.rrmse.mean, 0.02);
  EXPECT_DOUBLE_EQ(spreads.rrmse.worst, 0.03);
  EXPECT_DOUBLE_EQ(spreads.flicker.mean, 0.03) << "the first frame has none";
  EXPECT_DOUBLE_EQ(spreads.flicker.worst, 0.04);
  EXPECT_TRUE(std::isnan(spreads.same_surface_rrmse.mean));
  EXPECT_TRUE(std::isnan(spreads.same_surface_rrmse.worst));
}

TEST(Path, TellsMotionsApart) {
  const Comparison comparison = along_a_path();
  const std::vector<MotionShare> shares = shares_of_motion(*comparison.path, comparison.runs[0]);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_EQ(shares[0].motion, scene::Motion::all);
  EXPECT_EQ(shares[0].frames, 2);
  EXPECT_EQ(shares[0].shadow_maps, 1);
  EXPECT_EQ(shares[0].volumes, 2);
  EXPECT_DOUBLE_EQ(shares[0].ms, 25.0);
  EXPECT_EQ(shares[1].motion, scene::Motion::nothing);
  EXPECT_EQ(shares[1].volumes, 0);
  EXPECT_DOUBLE_EQ(shares[1].ms, 10.0);
}

TEST(Path, IsInResultsAndTable) {
  const json results = json::parse(results_json(along_a_path()));
  EXPECT_EQ(results["path"]["seconds"], 3.0);
  EXPECT_EQ(results["path"]["frames"][2]["moves"], "nothing");
  EXPECT_EQ(results["path"]["frames"][2]["dark"], true);
  const json& path = results["runs"][0]["path"];
  EXPECT_EQ(path["worst_frame"], 1);
  EXPECT_EQ(path["frame_ms"], (json{{"mean", 20.0}, {"worst", 30.0}}));
  EXPECT_TRUE(path["same_surface_rrmse"]["mean"].is_null());
  EXPECT_TRUE(path["frames"][0]["flicker"].is_null());
  EXPECT_EQ(path["frames"][1]["flicker"], 0.02);
  EXPECT_EQ(path["flicker"]["worst"], 0.04);
  EXPECT_EQ(path["frames"][0]["redrawn"], (json{"shadow_map", "volume"}));
  EXPECT_EQ(path["frames"][2]["redrawn"], json::array());
  EXPECT_TRUE(path["frames"][2]["rrmse"].is_null());
  EXPECT_EQ(path["frames"][1]["wrong_pixels"], 1);
  EXPECT_EQ(path["frames"][1]["undecided_pixels"], 2);
  EXPECT_EQ(path["frames"][1]["pixels"], 3);
  const std::string table = results_table(along_a_path());
  EXPECT_THAT(table, HasSubstr("path: 3 frames in 3 s"));
  EXPECT_THAT(table, testing::ContainsRegex("dark +dark +3 +4 +1\n"));
  EXPECT_THAT(table, testing::ContainsRegex("all +2 +1 +2 +25.00"));
  EXPECT_THAT(table, testing::ContainsRegex("nothing +1 +0 +0 +10.00"));
}

TEST(IsWorse, PrefersWhatIsNotDark) {
  AirlightError good{}, bad{}, dark{}, darker{};
  good.rrmse = 0.01;
  bad.rrmse = 0.02;
  dark.is_dark = darker.is_dark = true;
  dark.rmse = 5.0;
  darker.rmse = 1.0;
  EXPECT_TRUE(is_worse(bad, good));
  EXPECT_FALSE(is_worse(good, bad));
  EXPECT_TRUE(is_worse(good, dark));
  EXPECT_FALSE(is_worse(dark, good));
  EXPECT_TRUE(is_worse(dark, darker));
}

TEST(ViewOptions, ReadBackToTheSameNumbers) {
  scene::View view;
  view.camera.eye = {0.1, 1.0 / 3.0, -1e-7};
  view.medium.sigma_s = {0.1f, 1.0f / 3.0f, 2.0f};
  const auto options = view_options(view);
  EXPECT_EQ(options.at("eye"), "0.1,0.3333333333333333,-1e-07");
  EXPECT_EQ(options.at("sigma-s"), "0.1,0.33333334,2");
  EXPECT_EQ(options.at("size"), "512x512");
  EXPECT_FALSE(options.contains("rayleigh-weight"));
}

TEST(ViewOptions, NameTheWeightOfAPhaseFunctionThatHasOne) {
  Comparison comparison = two_runs();
  scene::Medium& medium = comparison.view.medium;
  medium = {.phase = scene::PhaseFunction::hoffman_preetham, .g = 0.8f, .rayleigh_weight = 0.3f};
  EXPECT_EQ(view_options(comparison.view).at("phase"), "hoffman-preetham");
  EXPECT_EQ(view_options(comparison.view).at("rayleigh-weight"), "0.3");
  EXPECT_EQ(json::parse(results_json(comparison))["view"]["medium"]["rayleigh_weight"], 0.3);
}

/// Expects each field in the options and in the results, but those that a light of this kind has not.
void expect_every_field(const Comparison& comparison) {
  const scene::View& view = comparison.view;
  const auto options = view_options(view);
  const json results = json::parse(results_json(comparison))["view"];
  std::size_t count = 0;
  const auto look_for = [&]<typename Thing>(const Thing& thing, const json& part) {
    for (const scene::Field<Thing>& field : scene::fields<Thing>()) {
      const bool is_there = std::is_same_v<Thing, scene::Light> ? !field.lack || !field.lack(thing) : true;
      EXPECT_EQ(options.contains(std::string(field.name)), is_there) << field.name;
      EXPECT_EQ(part.contains(field.key()), is_there) << field.name;
      count += is_there;
    }
  };
  look_for(view.camera, results.at("camera"));
  look_for(view.lights[0], results.at("lights").at(0));
  look_for(view.medium, results.at("medium"));
  look_for(view.surroundings, results);
  look_for(view, results);
  EXPECT_EQ(options.size(), count);
}

TEST(View, HasEveryFieldInMetadataAndResults) {
  Comparison comparison = two_runs();
  scene::View& view = comparison.view;
  view.lights[0].texture =
      std::make_shared<const scene::LightTexture>("a.exr", glm::ivec2(1), std::vector<glm::vec3>(1));
  view.lights[0].cone.emplace();
  view.lights[0].range = 7.0;
  view.medium.phase = scene::PhaseFunction::hoffman_preetham;
  view.medium.top = 16.0;
  expect_every_field(comparison);
  const json results = json::parse(results_json(comparison))["view"];
  EXPECT_EQ(results["lights"][0]["texture"], "a.exr");
  EXPECT_EQ(results["lights"][0]["angles"], (json{0.0, 45.0}));
  EXPECT_EQ(results["lights"][0]["range"], 7.0);
  EXPECT_EQ(results["size"], (json{512, 512}));
  EXPECT_EQ(results["camera"]["target"], (json{0.0, 0.0, -1.0}));
}

TEST(View, OfASunHasItsDirectionAndIrradiance) {
  Comparison comparison = two_runs();
  scene::View& view = comparison.view;
  view.lights[0] = scene::sun("noon", {0, 2, 0}, {3, 2, 1});
  view.medium = {.phase = scene::PhaseFunction::hoffman_preetham, .top = 16.0};
  expect_every_field(comparison);
  const json results = json::parse(results_json(comparison))["view"];
  EXPECT_EQ(results["lights"][0],
            (json{{"name", "noon"}, {"towards", {0.0, 1.0, 0.0}}, {"irradiance", {3.0, 2.0, 1.0}}}));
  EXPECT_EQ(results["medium"]["fog_top"], 16.0);
  EXPECT_EQ(view_options(view).at("sun"), "0,1,0");
  EXPECT_EQ(view_options(view).at("fog-top"), "16");
}

/// Two runs of two lights.
Comparison of_two_lights() {
  Comparison comparison = two_runs();
  comparison.view.lights = {scene::point_light("left", {1, 2, 3}, glm::vec3(4.0f)),
                            scene::sun("noon", {0, 1, 0}, glm::vec3(5.0f))};
  for (Run& run : comparison.runs)
    run.cost.lights = {{.is_skipped = true, .stages_ms = {}},
                       {.is_skipped = false, .stages_ms = {{"scan", 2.25}}}};
  return comparison;
}

TEST(View, OfSeveralLightsNamesEach) {
  const Comparison comparison = of_two_lights();
  const auto options = view_options(comparison.view);
  EXPECT_EQ(options.at("light.left.light-position"), "1,2,3");
  EXPECT_EQ(options.at("light.left.intensity"), "4,4,4");
  EXPECT_EQ(options.at("light.noon.sun"), "0,1,0");
  EXPECT_FALSE(options.contains("intensity"));
  const json results = json::parse(results_json(comparison))["view"];
  ASSERT_EQ(results["lights"].size(), 2u);
  EXPECT_EQ(results["lights"][0]["name"], "left");
  EXPECT_EQ(results["lights"][1]["irradiance"], (json{5.0, 5.0, 5.0}));
}

TEST(ResultsJson, HasWhatEachLightCost) {
  const json run = json::parse(results_json(of_two_lights()))["runs"][0];
  EXPECT_EQ(run["skipped_lights"], 1);
  EXPECT_EQ(run["lights"],
            json::array({{{"name", "left"}, {"skipped", true}, {"stages_ms", json::object()}},
                         {{"name", "noon"}, {"skipped", false}, {"stages_ms", {{"scan", 2.25}}}}}));
}

TEST(ResultsTable, HasARowOfStagesForEachOfSeveralLights) {
  const std::string table = results_table(of_two_lights());
  EXPECT_THAT(table, HasSubstr("left (skipped)"));
  EXPECT_THAT(table, HasSubstr(" 2.25\n"));
  EXPECT_THAT(results_table(two_runs()), testing::Not(HasSubstr("skipped")));
}

TEST(View, HasNoFieldsThatItsMediumHasNot) {
  Comparison comparison = two_runs();
  EXPECT_FALSE(view_options(comparison.view).contains("g"));
  EXPECT_FALSE(json::parse(results_json(comparison))["view"]["medium"].contains("g"));
}

TEST(WriteText, NamesTheFileThatCannotBeWritten) {
  EXPECT_THROW(write_text("/dev/full", "text"), scene::Error);
  EXPECT_THROW(write_text("/dev/null/file", "text"), scene::Error);
}

TEST(ShellQuote, QuotesWhatAShellWouldTouch) {
  EXPECT_EQ(shell_quote("vsv:integral=riemann,none"), "vsv:integral=riemann,none");
  EXPECT_EQ(shell_quote("a b"), "'a b'");
  EXPECT_EQ(shell_quote("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quote("$(x)"), "'$(x)'");
  EXPECT_EQ(shell_quote(""), "''");
}

}  // namespace
}  // namespace airlight::quality
