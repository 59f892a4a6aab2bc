#include "quality/joined_runs.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "scene/error.h"

namespace airlight::quality {
namespace {

using nlohmann::json;
using scene::Error;
using testing::HasSubstr;

json run(const std::string& key, const std::string& volume) {
  return {{"key", key},
          {"shadow_map", 512},
          {"volume", volume},
          {"surface", "shadow-map"},
          {"name", volume + "+shadow-map"},
          {"settings", json::object()},
          {"surface_settings", json::object()},
          {"command", "airlight compare hall"},
          {"stages_ms", {{"scan", 1.5}}},
          {"frame_ms", 10.0},
          {"bytes", {{"grid", 1000}, {"scene", 24}}},
          {"error",
           {{"airlight", {{"rrmse", 0.05}, {"p99", 0.2}, {"flip", 0.01}}},
            {"airlight_same_surface", {{"rrmse", 0.02}}}}}};
}

const json k_device = {{"renderer", "a GPU"}, {"version", "1"}, {"cores", 2}};

json results(const std::vector<json>& runs) {
  return {{"subject", "abc"},   {"scene", {{"name", "hall"}}},           {"view", {{"size", {64, 32}}}},
          {"device", k_device}, {"reference", {{"mean_airlight", 0.5}}}, {"runs", runs}};
}

/// A run of a sweep along a path of two frames.
json line(const std::string& key, const std::string& volume) {
  json swept = run(key, volume);
  swept.update({{"scene", "hall"}, {"subject", "abc"}, {"size", {64, 32}}, {"device", k_device}});
  swept["timing"] = {{"ratio", {{"median", 2.0}, {"low", 1.5}, {"high", 3.0}}}};
  swept["views"] = {{"frame_ms", {9.0, 11.0}},
                    {"same_surface_rrmse", {0.01, 0.03}},
                    {"p99", {0.2, 0.4}},
                    {"flip", {nullptr, 0.02}},
                    {"flicker", {nullptr, 0.004}}};
  return swept;
}

class Joined : public testing::Test {
 protected:
  Joined() {
    for (const char* name : {"a", "b"}) std::filesystem::create_directories(folder_ / name);
  }
  ~Joined() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  JoinedRuns join(const std::vector<std::string>& names) const {
    std::vector<std::filesystem::path> places;
    for (const std::string& name : names) places.push_back(folder_ / name);
    return join_runs(places);
  }
  /// The error of joining them.
  std::string complaint(const std::vector<std::string>& names) const {
    try {
      join(names);
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code, scene::ExitCode::bad_file);
      return error.what();
    }
    return "none";
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-joined-{}", getpid());
};

TEST_F(Joined, HaveTheFiguresOfAComparison) {
  write("a/results.json", results({run("k", "vsv:alpha=64")}).dump());
  const JoinedRuns joined = join({"a"});
  EXPECT_EQ(joined.scene, "hall");
  EXPECT_EQ(joined.size, glm::ivec2(64, 32));
  EXPECT_EQ(joined.views, 1u);
  EXPECT_THAT(joined.devices, testing::ElementsAre("a GPU, 2 cores"));
  EXPECT_EQ(joined.truth, folder_ / "a/reference");
  EXPECT_FALSE(joined.comparison.contains("runs"));
  ASSERT_EQ(joined.runs.size(), 1u);
  const JoinedRun& only = joined.runs[0];
  EXPECT_EQ(only.image, folder_ / "a/vsv:alpha=64+shadow-map");
  EXPECT_EQ(only.shadow_map, 512);
  EXPECT_DOUBLE_EQ(only.figures.ms, 10.0);
  EXPECT_DOUBLE_EQ(only.figures.rrmse, 0.02);
  EXPECT_DOUBLE_EQ(only.figures.p99, 0.2);
  EXPECT_DOUBLE_EQ(only.figures.flip, 0.01);
  EXPECT_DOUBLE_EQ(only.figures.bytes, 1024.0);
  EXPECT_TRUE(std::isnan(only.figures.flicker));
  EXPECT_TRUE(std::isnan(only.figures.ratio));
  EXPECT_TRUE(std::isnan(only.figures.ms_low));
}

TEST_F(Joined, HaveMeansOverTheViewsOfASweepAndItsIntervals) {
  write("a/runs.jsonl", line("k", "vsv").dump() + "\n");
  const JoinedRuns joined = join({"a"});
  EXPECT_EQ(joined.views, 2u);
  EXPECT_TRUE(joined.comparison.is_null());
  EXPECT_TRUE(joined.truth.empty());
  const Figures& figures = joined.runs.at(0).figures;
  EXPECT_DOUBLE_EQ(figures.rrmse, 0.02);
  EXPECT_DOUBLE_EQ(figures.p99, 0.3);
  EXPECT_DOUBLE_EQ(figures.flip, 0.02) << "a dark frame has none";
  EXPECT_DOUBLE_EQ(figures.flicker, 0.004);
  EXPECT_DOUBLE_EQ(figures.ratio, 2.0);
  EXPECT_DOUBLE_EQ(figures.ms_low, 7.5);
  EXPECT_DOUBLE_EQ(figures.ms_high, 15.0);
}

TEST_F(Joined, HaveMeansOverTheFramesOfAComparedPath) {
  json along = run("k", "vsv");
  along["path"]["frames"] = {{{"same_surface_rrmse", 0.01}, {"flip", 0.1}, {"flicker", nullptr}},
                             {{"same_surface_rrmse", 0.05}, {"flip", 0.3}, {"flicker", 0.002}}};
  json compared = results({along});
  compared["path"]["frames"] = {json::object(), json::object()};
  write("a/results.json", compared.dump());
  const JoinedRuns joined = join({"a"});
  EXPECT_EQ(joined.views, 2u);
  const Figures& figures = joined.runs.at(0).figures;
  EXPECT_DOUBLE_EQ(figures.rrmse, 0.03);
  EXPECT_DOUBLE_EQ(figures.flip, 0.2);
  EXPECT_DOUBLE_EQ(figures.flicker, 0.002);
  EXPECT_TRUE(std::isnan(figures.p99)) << "that of the worst frame is not the path's";
}

TEST_F(Joined, AreShardsAndFilesAndEachRunOnce) {
  write("a/runs-1-of-2.jsonl", line("1", "vsv").dump() + "\n{\"torn");
  write("a/runs-2-of-2.jsonl", line("2", "march").dump() + "\n" + line("1", "again").dump() + "\n");
  json compared = results({run("2", "march"), run("3", "froxel")});
  compared["runs"][0]["frame_ms"] = 99.0;
  write("b/results.json", compared.dump());
  const JoinedRuns joined = join({"a", "b", "a", "b/results.json"});
  ASSERT_EQ(joined.runs.size(), 3u);
  EXPECT_EQ(joined.runs[0].volume, "vsv");
  EXPECT_TRUE(joined.runs[0].image.empty());
  EXPECT_DOUBLE_EQ(joined.runs[1].figures.ms, 10.0) << "the first one's figures count";
  EXPECT_EQ(joined.runs[1].image, folder_ / "b/march+shadow-map")
      << "and the images of the one that has some";
  EXPECT_EQ(joined.runs[2].volume, "froxel");
  EXPECT_EQ(joined.comparison["subject"], "abc");
}

TEST_F(Joined, KeepDevicesApart) {
  json elsewhere = line("1", "vsv");
  elsewhere["device"]["renderer"] = "another GPU";
  write("a/runs.jsonl", line("1", "vsv").dump() + "\n" + elsewhere.dump() + "\n");
  const JoinedRuns joined = join({"a"});
  EXPECT_EQ(joined.devices.size(), 2u);
  ASSERT_EQ(joined.runs.size(), 2u);
  EXPECT_EQ(joined.runs[1].device, 1u);
}

TEST_F(Joined, OfNothingAreErrorsThatNameThePlace) {
  EXPECT_THAT(complaint({"nosuch"}), HasSubstr("nosuch: it is not there"));
  EXPECT_THAT(complaint({"b"}), HasSubstr("b: it holds neither results.json nor runs.jsonl"));
  write("a/runs.jsonl", "");
  EXPECT_THAT(complaint({"a"}), HasSubstr("a: it holds no runs"));
  write("a/runs.jsonl", line("1", "vsv").dump() + "\nno JSON\n");
  EXPECT_THAT(complaint({"a"}), HasSubstr("runs.jsonl, line 2: it is no run of airlight sweep"));
  for (const char* field :
       {"key", "volume", "bytes", "device", "frame_ms", "command", "settings", "views", "subject"}) {
    json broken = line("1", "vsv");
    broken.erase(field);
    write("a/runs.jsonl", broken.dump() + "\n");
    EXPECT_THAT(complaint({"a"}), HasSubstr("runs.jsonl, line 1: it is no run")) << field;
  }
  std::filesystem::remove(folder_ / "a/runs.jsonl");
  for (const std::string& text : {std::string("{"), std::string("[]"), results({{{"key", "1"}}}).dump()}) {
    write("a/results.json", text);
    EXPECT_THAT(complaint({"a"}), HasSubstr("results.json: it is no results.json of this airlight compare"))
        << text;
  }
}

TEST_F(Joined, OfAnotherSceneViewOrTruthAreErrorsThatNameThePlace) {
  write("a/results.json", results({run("1", "vsv")}).dump());
  json other = results({run("2", "vsv")});
  other["subject"] = "def";
  write("b/results.json", other.dump());
  EXPECT_THAT(complaint({"a", "b"}),
              testing::AllOf(HasSubstr("b/results.json: its camera, light, fog or geometry is not "
                                       "that of"),
                             HasSubstr("a/results.json")));
  other["scene"]["name"] = "fence";
  write("b/results.json", other.dump());
  EXPECT_THAT(complaint({"a", "b"}), HasSubstr("fence, 64x32 pixels against hall, 64x32 pixels"));
  other = results({run("2", "vsv")});
  other["reference"]["mean_airlight"] = 0.5001;
  write("b/results.json", other.dump());
  EXPECT_THAT(complaint({"a", "b"}), HasSubstr("b/results.json: its truth is not that of"));
  other["reference"]["mean_airlight"] = 0.5 + 1e-9;
  write("b/results.json", other.dump());
  EXPECT_EQ(join({"a", "b"}).runs.size(), 2u);
}

}  // namespace
}  // namespace airlight::quality
