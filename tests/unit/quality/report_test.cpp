#include "quality/report.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace airlight::quality {
namespace {

using testing::HasSubstr;
using testing::Not;

Comparison one_run() {
  Comparison comparison;
  comparison.scene = "<hall> & \"yard\"";
  comparison.truth.bound = 0.001;
  Run run;
  run.volume = "vsv:alpha=64";
  run.surface = "shadow-map";
  run.name = "vsv_alpha-64+shadow-map";
  run.command = "airlight compare 'a & b'";
  run.settings = {{"alpha", 64}};
  run.surface_settings = {{"theta", 32}};
  run.debug_images = {{"vsv_alpha-64+shadow-map_grid", "the grid, rows of θ", 0.25f}};
  run.cost.stages_ms = {{"scan", 3.5}};
  run.cost.frame_ms = 1.0;
  run.errors.airlight.rrmse = 0.0005;
  run.errors.surface = {.wrong_pixels = 12, .undecided_pixels = 345, .pixels = 7654};
  comparison.runs = {run};
  return comparison;
}

TEST(Report, ShowsEachRunWithItsImagesAndCommand) {
  const std::string html = report_html(one_run());
  EXPECT_THAT(html, HasSubstr("vsv:alpha=64"));
  EXPECT_THAT(html, HasSubstr("src=\"vsv_alpha-64%2Bshadow-map.png\""));
  EXPECT_THAT(html, HasSubstr("src=\"vsv_alpha-64%2Bshadow-map_error.png\""));
  EXPECT_THAT(html, HasSubstr("src=\"vsv_alpha-64%2Bshadow-map_surface.png\""));
  EXPECT_THAT(html, HasSubstr("<td>12 / 7654</td><td>345</td>"));
  EXPECT_THAT(html, HasSubstr("src=\"reference.png\""));
  EXPECT_THAT(html, HasSubstr("alpha=64"));
  EXPECT_THAT(html, HasSubstr("surface theta=32"));
  EXPECT_THAT(html, HasSubstr("src=\"vsv_alpha-64%2Bshadow-map_grid.png\""));
  EXPECT_THAT(html, HasSubstr("the grid, rows of θ; white is 25 %"));
  EXPECT_THAT(html, HasSubstr("<td>3.50</td>"));
  EXPECT_THAT(html, HasSubstr("airlight compare 'a &amp; b'"));
}

TEST(Report, NamesEachOfSeveralLights) {
  Comparison comparison = one_run();
  EXPECT_THAT(report_html(comparison), HasSubstr("<dt>light</dt>"));
  comparison.view.lights = {scene::point_light("a & b", {1, 2, 3}, glm::vec3(4.0f)),
                            scene::sun("noon", {0, 1, 0}, glm::vec3(5.0f))};
  comparison.runs[0].cost.lights = {{.is_skipped = false, .stages_ms = {{"scan", 1.25}}},
                                    {.is_skipped = true, .stages_ms = {}}};
  const std::string html = report_html(comparison);
  EXPECT_THAT(html, HasSubstr("<dt>light a &amp; b</dt>"));
  EXPECT_THAT(html, HasSubstr("<td>a &amp; b</td><td>1.25</td>"));
  EXPECT_THAT(html, HasSubstr("<td>noon (skipped)</td><td>–</td>"));
}

TEST(Report, EscapesWhatTheUserTyped) {
  const std::string html = report_html(one_run());
  EXPECT_THAT(html, HasSubstr("&lt;hall&gt; &amp; &quot;yard&quot;"));
  EXPECT_THAT(html, Not(HasSubstr("<hall>")));
}

TEST(Report, ClaimsNoErrorBelowThatOfTheReference) {
  EXPECT_THAT(report_html(one_run()), HasSubstr("<td>&lt; 0.1</td>"));
}

TEST(Report, DrawsTimeAndErrorAlongAPath) {
  Comparison comparison = one_run();
  comparison.path.emplace().seconds = 1.0;
  comparison.path->frames.resize(3);
  quality::Run& run = comparison.runs[0];
  run.debug_images = {};
  run.path.resize(3);
  run.path[0].cost.ms = 5.0;
  run.path[1].cost.ms = 10.0;
  run.path[2].errors.airlight.rrmse = std::numeric_limits<double>::quiet_NaN();
  run.worst_frame = 1;
  const std::string html = report_html(comparison);
  EXPECT_THAT(html, HasSubstr("points=\"60.0,100.0 320.0,10.0 580.0,190.0 \""));
  EXPECT_THAT(html, HasSubstr("points=\"60.0,190.0 320.0,190.0 \"")) << "the dark frame has no error";
  EXPECT_THAT(html, HasSubstr("src=\"vsv_alpha-64%2Bshadow-map_error_0001.png\""));
  EXPECT_THAT(html, HasSubstr("src=\"vsv_alpha-64%2Bshadow-map_surface_0001.png\""));
  EXPECT_THAT(html, HasSubstr("src=\"reference_0001.png\""));
  EXPECT_THAT(html, Not(HasSubstr("src=\"reference.png\"")));
}

TEST(Report, NeedsNothingFromElsewhere) {
  const std::string html = report_html(one_run());
  EXPECT_THAT(html, Not(HasSubstr("http")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace airlight::quality
