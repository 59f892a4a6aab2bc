#include "quality/front.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "scene/error.h"

namespace airlight::quality {
namespace {

using nlohmann::json;
using scene::Error;
using testing::HasSubstr;

json interval(double median, double spread = 0.1) {
  return {{"median", median}, {"low", median * (1.0 - spread)}, {"high", median * (1.0 + spread)}};
}

/// A run of one view.
json line(const std::string& volume, double error, double ratio, double spread = 0.1) {
  return {{"key", fmt::format("{} {} {}", volume, error, ratio)},
          {"scene", "hall"},
          {"subject", "abc"},
          {"size", {64, 32}},
          {"shadow_map", 512},
          {"device", {{"renderer", "a GPU"}, {"version", "1"}, {"cores", 2}}},
          {"volume", volume},
          {"surface", "shadow-map"},
          {"surface_settings", json::object()},
          {"bytes", {{"grid", 1048576}, {"scene", 524288}}},
          {"frame_ms", 10.0 * ratio},
          {"timing",
           {{"baseline",
             {{"key", "b"},
              {"volume", "vsv"},
              {"surface", "shadow-map"},
              {"shadow_map", 512},
              {"frame_ms", 10.0}}},
            {"ratio", interval(ratio, spread)}}},
          {"views", {{"same_surface_rrmse", {error}}, {"p99", {3.0 * error}}, {"flip", {2.0 * error}}}}};
}

class Fronts : public testing::Test {
 protected:
  Fronts() { std::filesystem::create_directories(folder_); }
  ~Fronts() override { std::filesystem::remove_all(folder_); }

  std::vector<Front> read(const std::vector<json>& lines, const char* error = "rrmse") const {
    std::ofstream stream(folder_ / "runs.jsonl");
    for (const json& l : lines) stream << l.dump() << '\n';
    stream.close();
    return read_fronts(std::vector{folder_}, parse_front_error(error));
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-front-{}", getpid());
};

/// That of the error 1 %.
const FrontLevel& at_one_percent(const Front& front) {
  return front.levels[2];
}

TEST_F(Fronts, HaveTheCheapestSettingThatReachesTheError) {
  const auto fronts = read({line("vsv:alpha=64", 0.03, 0.5), line("vsv:alpha=128", 0.009, 1.0),
                            line("vsv:alpha=256", 0.004, 2.0), line("march:steps=64", 0.008, 1.5),
                            line("march:steps=8", 0.04, 0.1)});
  ASSERT_EQ(fronts.size(), 1u);
  const std::vector<FrontLevel>& levels = fronts[0].levels;
  ASSERT_EQ(levels.size(), 6u);
  EXPECT_EQ(levels[0].best(), nullptr);
  EXPECT_EQ(levels[1].best()->volume, "vsv:alpha=256");
  EXPECT_EQ(levels[1].rival(), nullptr);
  EXPECT_EQ(levels[2].best()->volume, "vsv:alpha=128");
  EXPECT_EQ(levels[2].rival()->volume, "march:steps=64");
  EXPECT_EQ(levels[3].best()->volume, "vsv:alpha=128");
  EXPECT_EQ(levels[4].best()->volume, "march:steps=8");
  EXPECT_EQ(levels[4].rival()->volume, "vsv:alpha=64");
  EXPECT_EQ(levels[2].best()->bytes, 1572864);
  EXPECT_EQ(fronts[0].runs, 5u);
}

TEST_F(Fronts, AskAboutTheErrorThatIsNamed) {
  const std::vector<json> lines = {line("vsv:alpha=64", 0.012, 0.5), line("vsv:alpha=128", 0.006, 1.0)};
  // 0.6 % are 1.8 % of p99 and a FLIP of 0.012.
  const Front by_p99 = read(lines, "p99").at(0), by_flip = read(lines, "flip").at(0);
  EXPECT_EQ(by_p99.levels[0].best(), nullptr);
  ASSERT_NE(by_p99.levels[1].best(), nullptr);
  EXPECT_EQ(by_p99.levels[1].best()->volume, "vsv:alpha=128");
  EXPECT_EQ(by_flip.levels[1].best(), nullptr);
  EXPECT_EQ(by_flip.levels[2].best()->volume, "vsv:alpha=128");
  EXPECT_EQ(by_flip.levels[3].best()->volume, "vsv:alpha=64");
  EXPECT_THAT(front_tables(std::vector{by_flip}), HasSubstr("error: mean of HDR-FLIP."));
  EXPECT_THAT(front_tables(std::vector{by_flip}), HasSubstr("0.02   vsv:alpha=128"));
  EXPECT_THROW(parse_front_error("psnr"), scene::Error);
}

TEST_F(Fronts, AskAboutFlickerWhereSomethingMoves) {
  json of_path = line("vsv", 0.006, 1.0), of_view = line("march", 0.006, 0.5);
  of_path["views"]["flicker"] = {nullptr, 0.004, 0.008, 0.004, 0.008};
  for (const char* ratio : {"odd_ratio", "even_ratio"}) of_path["timing"][ratio] = interval(1.0, 0.1);
  of_view["views"]["flicker"] = {nullptr};
  const Front front = read({of_path, of_view}, "flicker").at(0);
  // Chosen by the odd frames' 0.4 %, and judged by the even ones' 0.8, among which the first, which has none,
  // does not count.
  EXPECT_EQ(front.levels[1].best(), nullptr);
  ASSERT_EQ(front.levels[1].methods.size(), 1u);
  EXPECT_FALSE(front.levels[1].methods[0].holds);
  ASSERT_NE(front.levels[2].best(), nullptr);
  EXPECT_EQ(front.levels[2].best()->volume, "vsv");
  EXPECT_DOUBLE_EQ(front.levels[2].best()->judged.error, 0.008);
  EXPECT_EQ(front.levels[2].rival(), nullptr);
}

TEST_F(Fronts, LeadOnlyWhereTheIntervalExcludesOne) {
  const FrontLevel clear = at_one_percent(read({line("a", 0.01, 1.0), line("b", 0.01, 1.3)})[0]);
  EXPECT_DOUBLE_EQ(clear.lead().median, 1.3);
  EXPECT_DOUBLE_EQ(clear.lead().low, 1.3 * 0.9 / 1.1);
  EXPECT_DOUBLE_EQ(clear.lead().high, 1.3 * 1.1 / 0.9);
  EXPECT_TRUE(clear.leads());
  const FrontLevel close = at_one_percent(read({line("a", 0.01, 1.0), line("b", 0.01, 1.2)})[0]);
  EXPECT_DOUBLE_EQ(close.lead().median, 1.2);
  EXPECT_FALSE(close.leads());
  // Settings of one method are no rivals of each other, and who is alone leads nobody.
  const FrontLevel alone = at_one_percent(read({line("a:x=1", 0.01, 1.0), line("a:x=2", 0.01, 9.0)})[0]);
  EXPECT_FALSE(alone.leads());
  EXPECT_TRUE(std::isnan(alone.lead().median));
  // What was timed once has no interval.
  json once = line("b", 0.01, 9.0);
  once["timing"]["ratio"] = {{"median", 9.0}, {"low", nullptr}, {"high", nullptr}};
  EXPECT_FALSE(at_one_percent(read({line("a", 0.01, 1.0), once})[0]).leads());
}

json path_line(const std::string& volume, const std::vector<double>& errors, double odd, double even) {
  json l = line(volume, 0.0, 0.5 * (odd + even));
  l["views"]["same_surface_rrmse"] = errors;
  l["timing"]["odd_ratio"] = interval(odd);
  l["timing"]["even_ratio"] = interval(even);
  return l;
}

TEST_F(Fronts, OfAPathChooseByOddViewsAndJudgeByEvenOnes) {
  const auto fronts = read({path_line("a:x=1", {0.002, 0.008, 0.004, 0.010}, 1.0, 3.0),
                            path_line("a:x=2", {0.003, 0.008, 0.003, 0.010}, 2.0, 0.5),  // not chosen
                            path_line("b", {0.001, 0.001, 0.001, 0.001}, 4.0, 6.0),
                            path_line("c", {0.020, 0.001, 0.020, 0.001}, 0.1, 0.1)});  // does not hold
  const FrontLevel& level = at_one_percent(fronts[0]);
  ASSERT_EQ(level.methods.size(), 3u);
  EXPECT_EQ(level.best()->volume, "a:x=1");
  EXPECT_DOUBLE_EQ(level.best()->judged.error, 0.003);
  EXPECT_DOUBLE_EQ(level.best()->chosen.error, 0.009);
  EXPECT_DOUBLE_EQ(level.lead().median, 2.0);
  EXPECT_EQ(level.methods[2].run.volume, "c");
  EXPECT_FALSE(level.methods[2].holds);
  EXPECT_EQ(fronts[0].views, 4u);
}

TEST_F(Fronts, LeaveOutDarkViews) {
  json l = path_line("a", {0.0, 0.0, 0.0, 0.0}, 1.0, 1.0);
  l["views"]["same_surface_rrmse"] = {nullptr, nullptr, 0.004, 0.006};
  EXPECT_DOUBLE_EQ(at_one_percent(read({l})[0]).best()->judged.error, 0.004);
  l["views"]["same_surface_rrmse"] = {0.001, nullptr, 0.001, nullptr};
  EXPECT_EQ(at_one_percent(read({l})[0]).best(), nullptr);
}

TEST_F(Fronts, KeepApartWhatCannotBeCompared) {
  const json usual = line("a", 0.01, 1.0);
  std::vector<json> lines = {usual};
  for (const char* pointer : {"/subject", "/device/renderer", "/timing/baseline/key", "/surface"}) {
    lines.push_back(usual);
    lines.back()[json::json_pointer(pointer)] = "another";
  }
  lines.push_back(usual);  // the same again
  const auto fronts = read(lines);
  EXPECT_EQ(fronts.size(), 5u);
  for (const Front& front : fronts) EXPECT_EQ(front.runs, 1u);
}

TEST_F(Fronts, AreToldInTablesAndJson) {
  const auto fronts = read({line("a", 0.01, 1.0), line("b", 0.01, 1.5)});
  const std::string tables = front_tables(fronts);
  EXPECT_THAT(tables, HasSubstr("hall, 64x32 pixels, 1 view, 2 runs; a GPU, 2 cores; surface shadow-map"));
  EXPECT_THAT(tables, HasSubstr("baseline: vsv × shadow-map, shadow map 512, 10 ms"));
  EXPECT_THAT(tables, HasSubstr("1.5 (1.23 to 1.83)  leads "));
  const json told = json::parse(front_json(fronts));
  const json& level = told["fronts"][0]["levels"][2];
  EXPECT_EQ(level["error"], 0.01);
  EXPECT_EQ(level["leads"], true);
  EXPECT_EQ(level["methods"][0]["volume"], "a");
  EXPECT_EQ(level["methods"][1]["judged"]["ratio"]["median"], 1.5);
  EXPECT_EQ(told["fronts"][0]["levels"][0]["lead"]["median"], nullptr);
}

TEST_F(Fronts, ReadFilesOfShardsAndNoTornLine) {
  std::ofstream(folder_ / "runs-1-of-2.jsonl") << line("a", 0.01, 1.0).dump() << "\n{\"key";
  std::ofstream(folder_ / "runs-2-of-2.jsonl") << line("b", 0.01, 1.0).dump() << '\n';
  EXPECT_EQ(read_fronts(std::vector{folder_})[0].runs, 2u);
  EXPECT_EQ(read_fronts(std::vector{folder_ / "runs-1-of-2.jsonl"})[0].runs, 1u);
}

TEST_F(Fronts, OfNoRunsAreErrors) {
  const auto complaint = [&](const std::filesystem::path& place) -> std::string {
    try {
      read_fronts(std::vector{place});
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(complaint(folder_), HasSubstr("it holds no runs"));
  EXPECT_THAT(complaint(folder_ / "nosuch"), HasSubstr("nosuch"));
  EXPECT_THAT(complaint(folder_ / "no.jsonl"), HasSubstr("it cannot be read"));
  json broken = line("a", 0.01, 1.0);
  broken["timing"].erase("baseline");
  for (const std::string& text : {std::string("no JSON"), std::string("[]"), broken.dump()}) {
    std::ofstream(folder_ / "runs.jsonl") << line("a", 0.01, 1.0).dump() << '\n' << text << '\n';
    EXPECT_THAT(complaint(folder_), HasSubstr("line 2: it is no run of airlight sweep"));
  }
  std::ofstream(folder_ / "runs.jsonl") << "";
  EXPECT_THAT(complaint(folder_), HasSubstr("it holds no runs"));
}

}  // namespace
}  // namespace airlight::quality
