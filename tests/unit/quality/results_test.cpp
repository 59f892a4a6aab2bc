#include "quality/results.h"

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

TEST(ErrorText, IsAPercentageOrABound) {
  EXPECT_EQ(error_text(0.02, 0.001), "2");
  EXPECT_EQ(error_text(0.001, 0.001), "< 0.1");
  EXPECT_EQ(error_text(0.0, 0.001), "< 0.1");
  EXPECT_EQ(error_text(0.0, 0.0), "0");
  EXPECT_EQ(error_text(std::numeric_limits<double>::quiet_NaN(), 0.001), "dark");
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
  look_for(view.lights[0], results.at("light"));
  look_for(view.medium, results.at("medium"));
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
  EXPECT_EQ(results["light"]["texture"], "a.exr");
  EXPECT_EQ(results["light"]["angles"], (json{0.0, 45.0}));
  EXPECT_EQ(results["light"]["range"], 7.0);
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
  EXPECT_EQ(results["light"],
            (json{{"name", "noon"}, {"towards", {0.0, 1.0, 0.0}}, {"irradiance", {3.0, 2.0, 1.0}}}));
  EXPECT_EQ(results["medium"]["fog_top"], 16.0);
  EXPECT_EQ(view_options(view).at("sun"), "0,1,0");
  EXPECT_EQ(view_options(view).at("fog-top"), "16");
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
