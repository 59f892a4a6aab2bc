#include "quality/report.h"

#include <filesystem>
#include <limits>
#include <regex>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "quality/results.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

Comparison one_run() {
  Comparison comparison;
  comparison.scene = "<hall> & \"yard\"";
  comparison.subject = "abc";
  comparison.truth.bound = 0.001;
  Run run;
  run.key = "1";
  run.volume = "vsv:alpha=64";
  run.surface = "shadow-map";
  run.name = "vsv_alpha-64+shadow-map";
  run.command = "airlight compare 'a & b'";
  run.settings = {{"alpha", 64}};
  run.surface_settings = {{"theta", 32}};
  run.cost.stages_ms = {{"scan", 3.5}};
  run.cost.frame_ms = 1.0;
  run.errors.airlight.rrmse = 0.0005;
  run.errors.surface = {.wrong_pixels = 12, .undecided_pixels = 345, .pixels = 7654};
  comparison.runs = {run};
  return comparison;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

/// What the page's scripts read.
json data_of(const std::string& html) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = html.find(begin) + begin.size();
  return json::parse(html.substr(from, html.find("</script>", from) - from));
}

class Report : public testing::Test {
 protected:
  Report() { std::filesystem::create_directories(folder_); }
  ~Report() override { std::filesystem::remove_all(folder_); }

  std::string page(const Comparison& comparison) const {
    write_text(folder_ / "results.json", results_json(comparison));
    return report_html({&folder_, 1});
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-report-{}", getpid());
};

TEST_F(Report, ShowsEachRunWithItsFiguresAndCommand) {
  const std::string html = page(one_run());
  EXPECT_THAT(html, HasSubstr("vsv:<wbr>alpha=64</th>"));
  EXPECT_THAT(
      html,
      HasSubstr("data-value=\"12\">12</td><td data-value=\"345\">345</td><td data-value=\"7654\">7654</td>"));
  EXPECT_THAT(html, HasSubstr("alpha=64, surface theta=32"));
  EXPECT_THAT(html, HasSubstr("<td data-value=\"3.5\">3.50</td>"));
  EXPECT_THAT(html, HasSubstr("airlight compare 'a &amp; b'"));
  const json run = data_of(html)["runs"][0];
  EXPECT_EQ(run["method"], "vsv");
  EXPECT_EQ(run["settings"]["alpha"], 64);
  EXPECT_EQ(run["command"], "airlight compare 'a & b'");
  EXPECT_EQ(run["figures"]["ms"], 1.0);
  EXPECT_TRUE(run["figures"]["ratio"].is_null());
}

TEST_F(Report, TellsRunsOfOneVolumeApartByTheirSurfaceShadow) {
  Comparison comparison = one_run();
  EXPECT_FALSE(data_of(page(comparison))["compares_surfaces"]);
  quality::Run other = comparison.runs[0];
  other.key = "2";
  other.surface = "psv:cull=auto";
  other.errors.surface.wrong_pixels = 0;
  comparison.runs.push_back(other);
  json data = data_of(page(comparison));
  EXPECT_TRUE(data["compares_surfaces"]);
  EXPECT_EQ(data["runs"][0]["method"], "shadow-map");
  EXPECT_EQ(data["runs"][1]["method"], "psv");
  EXPECT_NEAR(data["runs"][0]["figures"]["wrong"].get<double>(), 12.0 / 7654.0, 1e-8);
  EXPECT_EQ(data["runs"][1]["figures"]["wrong"], 0.0);
  EXPECT_NEAR(data["pixel"].get<double>(), 1.0 / 7654.0, 1e-8);
  comparison.runs[1].volume = "march";
  data = data_of(page(comparison));
  EXPECT_FALSE(data["compares_surfaces"]);
  EXPECT_EQ(data["runs"][1]["method"], "march");
}

TEST_F(Report, LeavesOutColumnsInWhichNothingStands) {
  Comparison comparison = one_run();
  EXPECT_THAT(page(comparison), Not(HasSubstr("M/s</span></th>")));
  comparison.runs[0].cost.rays = 1;
  comparison.runs[0].cost.mrays_per_s = 20.0;
  EXPECT_THAT(page(comparison), HasSubstr("M/s</span></th>"));
}

TEST_F(Report, SaysWhatWasSeen) {
  const std::string html = page(one_run());
  EXPECT_THAT(html, HasSubstr("<dt>image</dt><dd>size 512x512 pixels"));
  EXPECT_THAT(html, HasSubstr("<dt>camera</dt><dd>"));
  EXPECT_THAT(html, HasSubstr("<dt>medium</dt><dd>"));
}

TEST_F(Report, NamesEachOfSeveralLights) {
  Comparison comparison = one_run();
  EXPECT_THAT(page(comparison), HasSubstr("<dt>light</dt>"));
  comparison.view.lights = {scene::point_light("a & b", {1, 2, 3}, glm::vec3(4.0f)),
                            scene::sun("noon", {0, 1, 0}, glm::vec3(5.0f))};
  comparison.runs[0].cost.lights = {{.is_skipped = false, .stages_ms = {{"scan", 1.25}}},
                                    {.is_skipped = true, .stages_ms = {}}};
  const std::string html = page(comparison);
  EXPECT_THAT(html, HasSubstr("<dt>light a &amp; b</dt>"));
  EXPECT_THAT(html, HasSubstr("a &amp; b</td><td data-value=\"1.25\">1.25</td>"));
  EXPECT_THAT(html, HasSubstr("noon (skipped)</td><td>–</td>"));
}

TEST_F(Report, IsNotLeftByNames) {
  Comparison comparison = one_run();
  comparison.runs[0].volume = "</script><b onclick='x'>{{data}}";
  comparison.runs[0].command = "airlight compare '</SCRIPT><img src=x>' <!--";
  comparison.report.warnings = {"<i>\xff"};
  const std::string html = page(comparison);
  EXPECT_THAT(html, HasSubstr("&lt;hall&gt; &amp; &quot;yard&quot;"));
  for (const char* tag : {"<hall>", "<b onclick", "<img", "<i>", "</SCRIPT"})
    EXPECT_THAT(html, Not(HasSubstr(tag)));
  EXPECT_EQ(count(html, "<script"), count(html, "</script"));
  EXPECT_EQ(data_of(html)["runs"][0]["volume"], comparison.runs[0].volume);
  EXPECT_EQ(data_of(html)["runs"][0]["command"], comparison.runs[0].command);
}

TEST_F(Report, ClaimsNoErrorBelowThatOfTheTruth) {
  EXPECT_THAT(page(one_run()), HasSubstr("<td data-value=\"0.05\">&lt; 0.1</td>"));
}

TEST_F(Report, OfADarkTruthTellsNoRelativeError) {
  Comparison comparison = one_run();
  comparison.runs[0].errors.airlight.is_dark = comparison.runs[0].errors.same_surface.is_dark = true;
  const std::string html = page(comparison);
  EXPECT_THAT(html, HasSubstr("is not above the floor"));
  EXPECT_THAT(html, HasSubstr("<td>dark</td>"));
  for (const char* word : {"inf<", ">inf", "nan<", ">nan"}) EXPECT_THAT(html, Not(HasSubstr(word)));
}

TEST_F(Report, TellsTimeAndErrorAlongAPath) {
  Comparison comparison = one_run();
  comparison.path.emplace().seconds = 1.0;
  comparison.path->frames.resize(3);
  for (std::size_t i = 0; i < 2; ++i) comparison.path->frames[i].motion = scene::Motion::all;
  quality::Run& run = comparison.runs[0];
  run.path.resize(3);
  run.path[0].cost = {.ms = 5.0, .stages_ms = {}, .redrawn = {"shadow_map"}};
  run.path[1].cost = {.ms = 10.0, .stages_ms = {}, .redrawn = {}};
  run.path[2].cost = {.ms = 30.0, .stages_ms = {}, .redrawn = {}};
  run.path[0].errors.airlight.rrmse = 0.01;
  run.path[1].errors.airlight.rrmse = 0.03;
  run.path[2].errors.airlight.rrmse = std::numeric_limits<double>::quiet_NaN();
  run.path[2].flicker = 0.02;
  run.worst_frame = 1;
  const std::string html = page(comparison);
  EXPECT_THAT(html, HasSubstr("<p>3 frames in 1 s."));
  EXPECT_THAT(html, HasSubstr("<td data-value=\"15\">15.00</td><td data-value=\"30\">30.00</td>"
                              "<td data-value=\"2\">2</td><td data-value=\"3\">3</td>"));
  EXPECT_THAT(
      html,
      HasSubstr("<td data-value=\"2\">2</td><td data-value=\"2\">2</td><td data-value=\"1\">1</td></tr>"))
      << "flicker, mean and worst, and the worst frame";
  EXPECT_THAT(html, HasSubstr("all</td><td data-value=\"2\">2</td><td data-value=\"1\">1</td>"
                              "<td data-value=\"0\">0</td><td data-value=\"7.5\">7.50</td>"));
  EXPECT_THAT(html, HasSubstr("nothing</td><td data-value=\"1\">1</td>"));
  const json along = data_of(html)["runs"][0]["along"];
  EXPECT_EQ(along["frame_ms"], (json{5.0, 10.0, 30.0}));
  EXPECT_TRUE(along["rrmse"][2].is_null());
  EXPECT_THAT(html, HasSubstr("Along a path no images of radiance are kept."));
}

TEST_F(Report, TellsApartWhatMovesAlongAPath) {
  Comparison comparison = one_run();
  comparison.path.emplace().seconds = 1.0;
  quality::Run& run = comparison.runs[0];
  for (const scene::Motion motion : scene::k_motions) {
    comparison.path->frames.emplace_back().motion = motion;
    run.path.emplace_back();
  }
  const std::string html = page(comparison);
  for (const scene::Motion motion : scene::k_motions)
    EXPECT_THAT(html,
                HasSubstr(fmt::format("{}</td><td data-value=\"1\">1</td>", scene::motion_name(motion))));
}

TEST_F(Report, MarksTheFront) {
  Comparison comparison = one_run();
  comparison.runs[0].errors.same_surface.rrmse = 0.02;
  for (const auto& [key, ms, error] : {std::tuple("2", 2.0, 0.01), {"3", 2.5, 0.015}, {"4", 1.0, 0.02}}) {
    quality::Run run = comparison.runs[0];
    run.key = key;
    run.cost.frame_ms = ms;
    run.errors.same_surface.rrmse = error;
    comparison.runs.push_back(run);
  }
  EXPECT_EQ(count(page(comparison), "<td data-value=\"1\">●</td>"), 3u)
      << "two that are the same are both on it";
}

TEST_F(Report, NeedsNothingFromElsewhere) {
  const std::string html = page(one_run());
  const std::regex address("(src|href|action|data)\\s*=\\s*[\"'](?!#|\\{|data:)", std::regex::icase);
  EXPECT_FALSE(std::regex_search(html, address));
  for (const char* word : {"url(", "@import", "<link", "fetch(", "XMLHttpRequest", "import("})
    EXPECT_THAT(html, Not(HasSubstr(word)));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
}

TEST_F(Report, OfWhatIsNotWhatItShouldBeIsAnError) {
  json results = json::parse(results_json(one_run()));
  results["runs"][0]["error"]["airlight"]["dark"] = "perhaps";
  write_text(folder_ / "results.json", results.dump());
  EXPECT_THROW(report_html({&folder_, 1}), scene::Error);
}

}  // namespace
}  // namespace airlight::quality
