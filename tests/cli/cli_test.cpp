// The contract of the command line: what goes in, what comes out, where, and with which exit code.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "cli/schema.h"
#include "quality/axes.h"
#include "quality/compare.h"
#include "quality/image_io.h"
#include "quality/run_file.h"
#include "scene/view_fields.h"
#include "support/models.h"
#include "support/paths.h"
#include "support/tev_listener.h"

namespace airlight {
namespace {

namespace fs = std::filesystem;
using quality::Image;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using tests::Json;
using Words = std::vector<std::string>;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Result {
  int exit_code;
  std::string out, err;
};

/// A folder of its own for each test, in which the program runs.
class CommandLine : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = fmt::format("airlight-{}-{}-{}", getpid(), test->test_suite_name(), test->name());
    std::replace(name.begin(), name.end(), '/', '-');
    folder_ = fs::temp_directory_path() / name;
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name) const { return folder_ / name; }

  Result shell(const std::string& command) const {
    const std::string line = fmt::format("cd {} && ( {} ) >stdout 2>stderr </dev/null",
                                         quality::shell_quote(folder_.string()), command);
    const int status = std::system(line.c_str());
    EXPECT_TRUE(WIFEXITED(status)) << command;
    return {WEXITSTATUS(status), read_text(file("stdout")), read_text(file("stderr"))};
  }

  Result airlight(const Words& arguments) const {
    std::string command = fmt::format("timeout 60 {}", quality::shell_quote(AIRLIGHT_BINARY));
    for (const std::string& argument : arguments)
      command += fmt::format(" {}", quality::shell_quote(argument));
    return shell(command);
  }

  /// Runs with a small image and, where a method has them, a small grid and shadow map, where `arguments` do
  /// not say otherwise.
  Result small(Words arguments) const {
    const auto value_of = [&](const char* option, const char* usual) -> std::string {
      const auto found = std::find(arguments.begin(), arguments.end(), option);
      return found == arguments.end() ? usual : *std::next(found);
    };
    const std::string methods = value_of("--volume", "vsv") + "," + value_of("--surface", "shadow-map");
    std::vector<std::pair<std::string, std::string>> defaults = {{"--size", "32x32"}};
    const bool has_grid = methods.find("vsv") != std::string::npos;
    if (has_grid) defaults.insert(defaults.end(), {{"--alpha", "64"}, {"--theta", "128"}, {"--phi", "128"}});
    if (has_grid || methods.find("shadow-map") != std::string::npos)
      defaults.emplace_back("--shadow-map", "128");
    for (const auto& [name, value] : defaults) {
      if (std::find(arguments.begin(), arguments.end(), name) != arguments.end()) continue;
      arguments.insert(arguments.end(), {name, value});
    }
    return airlight(arguments);
  }

  /// Renders an image of `cornell`, or of the scene that `arguments` begin with.
  Image render(const Words& arguments) const {
    const bool names_scene = !arguments.empty() && arguments[0][0] != '-';
    Words all = {"render"};
    if (!names_scene) all.push_back("cornell");
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", "image.exr"});
    const Result result = small(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return quality::read_exr(file("image.exr"));
  }

  Json compare(const Words& arguments) const {
    Words all = {"compare", "cornell", "-o", "out", "--frames", "2"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Result result = small(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Json::parse(read_text(file("out/results.json")));
  }

  fs::path folder_;
};

double mean(const std::vector<float>& values) {
  double sum = 0.0;
  for (float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

void expect_one_line_error(const Result& result, int exit_code) {
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_THAT(result.err, StartsWith("airlight: "));
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
}

using Commands = CommandLine;

TEST_F(Commands, HelpAndVersionAreData) {
  for (const Words& words : {Words{"--help"},
                             {"render", "--help"},
                             {"compare", "--help"},
                             {"sweep", "--help"},
                             {"front", "--help"},
                             {"--version"}}) {
    const Result result = airlight(words);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr("airlight"));
    EXPECT_THAT(result.err, IsEmpty());
  }
}

TEST_F(Commands, HelpNamesTheSceneWhereOneIsLeftOut) {
  EXPECT_THAT(airlight({"view", "--help"}).out, HasSubstr("(default: jali)"));
  EXPECT_THAT(airlight({"compare", "--help"}).out, HasSubstr(".ply file (default: window)"));
  EXPECT_THAT(airlight({"render", "--help"}).out, Not(HasSubstr(".ply file (default")));
}

TEST_F(Commands, HelpExplainsEveryFieldOfAView) {
  for (const char* command : {"render", "compare", "sweep"}) {
    const std::string help = airlight({command, "--help"}).out;
    for (const scene::FieldInfo* field : scene::every_field()) {
      EXPECT_THAT(help, HasSubstr(fmt::format("--{} {} ", field->name, field->placeholder)));
      EXPECT_THAT(help, HasSubstr(field->help()));
    }
  }
}

TEST_F(Commands, ImageMeasuresImages) {
  for (const char* volume : {"vsv", "march:steps=8"})
    ASSERT_EQ(airlight({"render", "cornell", "--size", "24x16", "--shadow-map", "64", "--volume", volume,
                        "-o", std::string(volume).substr(0, 3) + ".exr", "--quiet"})
                  .exit_code,
              0);
  const Result same = airlight({"image", "error", "vsv.exr", "vsv.exr", "--json", "-"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(Json::parse(same.out)["airlight"]["rmse"], 0.0);
  const Json error = Json::parse(
      airlight({"image", "error", "mar.exr", "vsv.exr", "--layer", "airlight", "--json", "-"}).out);
  EXPECT_GT(error["airlight"]["rrmse"], 0.001);
  EXPECT_EQ(error["airlight_same_surface"]["left_out_pixels"], 0);
  EXPECT_THAT(airlight({"image", "error", "mar.exr", "vsv.exr"}).out, HasSubstr("same-surface rrmse"));

  EXPECT_EQ(airlight({"image", "flip", "vsv.exr", "vsv.exr"}).out, "0\n");
  EXPECT_EQ(airlight({"image", "flip", "mar.exr", "vsv.exr", "--exposure", "2", "-o", "flip.png"}).exit_code,
            0);
  EXPECT_EQ(read_text(file("flip.png")).substr(1, 3), "PNG");

  EXPECT_EQ(airlight({"image", "diff", "mar.exr", "vsv.exr", "-o", "diff.exr"}).exit_code, 0);
  EXPECT_EQ(read_text(file("diff.png")).substr(1, 3), "PNG");
  const quality::Image diff = quality::read_exr(file("diff.exr"));
  EXPECT_EQ(diff.channels.at("airlight.R")[7],
            quality::read_exr(file("mar.exr")).channels.at("airlight.R")[7] -
                quality::read_exr(file("vsv.exr")).channels.at("airlight.R")[7]);

  EXPECT_EQ(airlight({"image", "crop", "vsv.exr", "--crop", "4,0,8,16", "-o", "part.exr"}).exit_code, 0);
  EXPECT_THAT(airlight({"image", "info", "part.exr"}).out, HasSubstr("8x16 pixels\n"));

  expect_one_line_error(airlight({"image"}), 2);
  expect_one_line_error(airlight({"image", "blur", "vsv.exr"}), 2);
  expect_one_line_error(airlight({"image", "error", "vsv.exr"}), 2);
  expect_one_line_error(airlight({"image", "info", "vsv.exr", "--layer", "airlight"}), 2);
  expect_one_line_error(airlight({"image", "info", "vsv.exr", "-o", "x.exr"}), 2);
  expect_one_line_error(airlight({"image", "diff", "vsv.exr", "mar.exr"}), 2);
  expect_one_line_error(airlight({"image", "flip", "vsv.exr", "mar.exr", "--exposure", "0"}), 2);
  for (const char* part : {"1,2,3", "1,2,3,x", "0,0,25,16", "-1,0,2,2", "1,2,3,4,5"})
    expect_one_line_error(airlight({"image", "crop", "vsv.exr", "--crop", part, "-o", "part.exr"}), 2);
  expect_one_line_error(airlight({"image", "error", "part.exr", "vsv.exr"}), 3);
  expect_one_line_error(airlight({"image", "error", "nosuch.exr", "vsv.exr"}), 3);
  expect_one_line_error(airlight({"image", "error", "vsv.exr", "vsv.exr", "--layer", "glow"}), 3);
}

TEST_F(Commands, TuneFindsTheSettingThatReachesAGoal) {
  const auto tune = [&](std::vector<std::string> words) {
    std::vector<std::string> all = {
        "tune",         "cornell",  "--size",    "48x48", "--volume", "vsv:phi={128,256},march:steps={8,64}",
        "--shadow-map", "{64,256}", "--surface", "none",  "--frames", "2",
        "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    return airlight(all);
  };
  const Result found = tune({"--max-error", "0.05", "--json", "-"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const Json json = Json::parse(found.out);
  EXPECT_EQ(json["met"], true);
  EXPECT_GT(json["error"], 0.0);
  EXPECT_LE(json["error"], 0.05);
  EXPECT_GT(json["bytes"], 0);
  EXPECT_GT(json["frame_ms"], 0.0);
  EXPECT_GE(json["confidence"], 0.0);
  EXPECT_EQ(json["tried"]["settings"], 8);
  EXPECT_TRUE(json["shadow_map"] == 64 || json["shadow_map"] == 256);

  // The least error of what is allowed is that of the finest.
  const Json finest = Json::parse(tune({"--max-bytes", "1e9", "--json", "-"}).out);
  EXPECT_EQ(finest["shadow_map"], 256);
  EXPECT_LE(finest["error"], json["error"]);

  const Result missed = tune({"--max-error", "1e-9"});
  EXPECT_EQ(missed.exit_code, 1);
  EXPECT_THAT(missed.out, HasSubstr("nothing reaches the goal"));
  expect_one_line_error(tune({"--max-error", "0.1", "--max-ms", "10"}), 2);
  expect_one_line_error(tune({"--max-ms", "-1"}), 2);
  expect_one_line_error(tune({}), 2);

  // Its lines are a shot's.
  const std::string text = tune({"--max-error", "0.05", "--explain"}).out;
  const std::size_t begin = text.find("[methods]"), end = text.find("//");
  ASSERT_NE(end, std::string::npos);
  EXPECT_THAT(text, HasSubstr("theta"));
  std::ofstream(file("shot.toml")) << "scene = \"cornell\"\n" << text.substr(begin, end - begin);
  ASSERT_EQ(airlight({"render", "shot.toml", "--size", "16x16", "-o", "shot.exr", "--quiet"}).exit_code, 0);
  const std::string spec = text.substr(begin + 20, text.find('"', begin + 20) - begin - 20);
  EXPECT_THAT(airlight({"image", "info", "shot.exr"}).out, HasSubstr(spec));
}

TEST_F(Commands, ScenesListsEveryBuiltinScene) {
  const Result result = airlight({"scenes"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* name : {"window", "nave", "fence", "forest", "jali", "chapel", "lighthouse", "harbour",
                           "spheres", "toroid", "cornell", "empty", "half-space", "sphere"}) {
    EXPECT_THAT(result.out, HasSubstr(name));
  }
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(Commands, InfoNamesDriverAndLimits) {
  const Result result = airlight({"info"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* word : {"renderer", "OpenGL", "storage block", "Embree", "cores"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

TEST_F(Commands, InfoTellsWhatASceneHolds) {
  const Result result = airlight({"info", "half-space"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* text : {"triangles                 2,", "lights                    1\n",
                           "5: 4 open, 0 of more than two triangles, at most 2 triangles\n"})
    EXPECT_THAT(result.out, HasSubstr(text));
  EXPECT_THAT(airlight({"info", "spheres", "--triangles", "8000"}).out, HasSubstr("8000"));
  expect_one_line_error(airlight({"info", "nowhere.glb"}), 3);
  expect_one_line_error(airlight({"info", "cornell", "--triangles", "8000"}), 2);
}

TEST_F(Commands, FullStandardOutputIsAnError) {
  const Result result = shell(quality::shell_quote(AIRLIGHT_BINARY) + " scenes >/dev/full");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("standard output"));
}

/// Arguments that are wrong, and what the message must hold.
struct Misuse {
  Words arguments;
  std::string says;
};

void PrintTo(const Misuse& misuse, std::ostream* stream) {
  *stream << testing::PrintToString(misuse.arguments);
}

class Usage : public CommandLine, public testing::WithParamInterface<Misuse> {};

TEST_P(Usage, IsRefusedInOneLineThatNamesTheCulprit) {
  Words arguments = GetParam().arguments;
  if (!arguments.empty() && arguments[0][0] == '-' && arguments[0] != "--quiet") {
    arguments.insert(arguments.begin(), {"render", "cornell", "-o", "x.exr"});
  }
  const Result result = airlight(arguments);
  expect_one_line_error(result, 2);
  EXPECT_THAT(result.err, HasSubstr(GetParam().says));
  EXPECT_FALSE(fs::exists(file("x.exr")));
}

INSTANTIATE_TEST_SUITE_P(
    Words, Usage,
    testing::Values(Misuse{{}, "names no command"}, Misuse{{"tune", "window"}, "tune"},
                    Misuse{{"report"}, "DIR"}, Misuse{{"report", "out"}, "-o"},
                    Misuse{{"report", "out", "-o", "x.exr"}, ".html"},
                    Misuse{{"report", "out", "-o", "x.html", "--images", "0"}, "--images"},
                    Misuse{{"report", "out", "--volume", "vsv"}, "--volume"}, Misuse{{"--quiet"}, "--quiet"},
                    Misuse{{"render"}, "SCENE"}, Misuse{{"render", "cornell"}, "-o"},
                    Misuse{{"render", "cornell", "-o"}, "-o"},
                    Misuse{{"render", "cornell", "-o", "x.jpg"}, ".exr"}, Misuse{{"scenes", "more"}, "more"},
                    Misuse{{"render", "cornell", "more", "-o", "x.exr"}, "more"},
                    Misuse{{"--debug"}, "--debug"}, Misuse{{"--light-texture"}, "--light-texture"},
                    Misuse{{"--max-error", "1"}, "--max-error: no count of the method is auto"},
                    Misuse{{"--alpha", "auto", "--max-error", "0"}, "--max-error: '0' is not above 0"},
                    Misuse{{"--frames", "3"}, "--frames"},
                    Misuse{{"--fov", "30", "--fov", "40"}, "--fov: it is given twice"},
                    Misuse{{"--fov", "30", "--fov=40"}, "--fov: it is given twice"},
                    Misuse{{"render", "cornell", "--quiet", "--quiet"}, "--quiet: it is given twice"},
                    Misuse{{"-oy.exr"}, "-o: it is given twice"}, Misuse{{"--quiet=no"}, "takes no value"},
                    Misuse{{"--fov"}, "its DEG is missing"},
                    Misuse{{"--tev=nowhere"}, "--tev: 'nowhere' is not HOST:PORT"},
                    Misuse{{"compare", "cornell", "--max-error=-1"}, "--max-error"},
                    Misuse{{"compare", "cornell", "--max-error", "nan"}, "--max-error"},
                    Misuse{{"compare", "cornell", "--max-error", "1", "--volume", "none"}, "--max-error"},
                    Misuse{{"--max-undecided", "1"}, "--max-undecided"},
                    Misuse{{"compare", "cornell", "--max-undecided=-0.1"}, "--max-undecided"},
                    Misuse{{"compare", "cornell", "--max-undecided", "1.1"}, "--max-undecided"},
                    Misuse{{"compare", "cornell", "--max-undecided", "nan"}, "--max-undecided"},
                    Misuse{{"compare", "cornell", "--frames", "0"}, "--frames"},
                    Misuse{{"compare", "cornell", "--volume", "vsv,vsv"}, "twice"}));

INSTANTIATE_TEST_SUITE_P(
    Numbers, Usage,
    testing::Values(
        Misuse{{"--size", "0x32"}, "--size"}, Misuse{{"--size", "32"}, "--size"},
        Misuse{{"--size=-32x32"}, "--size"}, Misuse{{"--size", "32x32x32"}, "--size"},
        Misuse{{"--size", "99999999999x32"}, "--size"}, Misuse{{"--size", "32x32 "}, "--size"},
        Misuse{{"--eye", "nan,0,0", "--target", "0,0,0"}, "--eye"},
        Misuse{{"--eye", "0,0,1", "--target", "0,inf,0"}, "--target"},
        Misuse{{"--eye", "0,0", "--target", "0,0,0"}, "--eye"},
        Misuse{{"--eye", "0,0,1e999", "--target", "0,0,0"}, "--eye"}, Misuse{{"--fov", "0"}, "--fov"},
        Misuse{{"--fov", "180"}, "--fov"}, Misuse{{"--fov", "40deg"}, "--fov"},
        Misuse{{"--fov", ""}, "--fov"}, Misuse{{"--intensity", "1,2"}, "--intensity"},
        Misuse{{"--intensity=-1"}, "--intensity"}, Misuse{{"--intensity", "1e39"}, "--intensity"},
        Misuse{{"--intensity", "1e38"}, "--intensity: it is more than 1e+30 W/sr"},
        Misuse{{"--sigma-s", "1,2e6,1"}, "--sigma-s: it is more than 1e+06 1/m"},
        Misuse{{"--sigma-a", "1e38"}, "--sigma-a: it is more than"},
        Misuse{{"--intensity", "1e30"}, "lower --intensity"}, Misuse{{"--sigma-s", "nan"}, "--sigma-s"},
        Misuse{{"--sigma-a=-0.1"}, "--sigma-a"}, Misuse{{"--g", "nan"}, "--g"},
        Misuse{{"--phase", "henyey-greenstein", "--g", "1"}, "--g"},
        Misuse{{"--phase", "henyey-greenstein", "--g", "-0.999"}, "g = -0.999: the limit is |g| = 0.995"},
        Misuse{{"--phase", "hoffman-preetham", "--rayleigh-weight", "1.1"}, "--rayleigh-weight"},
        Misuse{{"--phase", "hoffman-preetham", "--rayleigh-weight=-0.1"}, "--rayleigh-weight"},
        Misuse{{"--phase", "hoffman-preetham", "--rayleigh-weight", "nan"}, "--rayleigh-weight"},
        Misuse{{"--g", "0.5"}, "henyey-greenstein"}, Misuse{{"--albedo", "1.5"}, "--albedo"},
        Misuse{{"--looks", "nice"}, "use flat, textured"}, Misuse{{"--tone-map", "nice"}, "--tone-map"},
        Misuse{{"--ambient", "fitted"}, "--ambient"}, Misuse{{"--background=-1"}, "--background"},
        Misuse{{"--exposure", "0"}, "--exposure"}, Misuse{{"--exposure", "inf"}, "--exposure"},
        Misuse{{"--shadow-map", "0"}, "--shadow-map"},
        Misuse{{"--reference-samples", "128"}, "--reference-samples"},
        Misuse{{"--volume", "reference:samples=128"}, "samples"}, Misuse{{"--alpha", "0"}, "--alpha"},
        Misuse{{"--theta=-5"}, "--theta"}, Misuse{{"--phi", "100"}, "--phi"},
        Misuse{{"--phi", "0x80"}, "--phi"}));

INSTANTIATE_TEST_SUITE_P(
    Choices, Usage,
    testing::Values(
        Misuse{{"--triangles", "5000"}, "spheres, toroid"},
        Misuse{{"render", "mesh.ply", "-o", "x.exr", "--triangles", "5000"}, "spheres, toroid"},
        Misuse{{"render", "spheres", "-o", "x.exr", "--triangles", "1999"}, "2000 and 100000000"},
        Misuse{{"render", "toroid", "-o", "x.exr", "--triangles", "100000001"}, "--triangles"},
        Misuse{{"render", "toroid", "-o", "x.exr", "--triangles", "5e4"}, "--triangles"},
        Misuse{{"--camera", "back"}, "front"}, Misuse{{"--camera", "1"}, "front"},
        Misuse{{"--light", "sun"}, "ceiling"}, Misuse{{"--light", "99999999999999999999"}, "ceiling"},
        Misuse{{"--eye", "0,0,1"}, "--target"}, Misuse{{"--target", "0,0,1"}, "--eye"},
        Misuse{{"--camera", "0", "--eye", "0,0,1", "--target", "0,0,0"}, "--camera"},
        Misuse{{"--eye", "0,0,1", "--target", "0,0,1"}, "eye and target"},
        Misuse{{"--up", "0,0,1"}, "parallel"}, Misuse{{"--light-position", "0,1,0"}, "--intensity"},
        Misuse{{"--light", "0", "--light", "ceiling"}, "--light: the light 'ceiling' is chosen twice"},
        Misuse{{"--light", "all", "--light", "0"}, "--light: the light 'ceiling' is chosen twice"},
        Misuse{{"--light", "0", "--light-position", "0,1,0"}, "--light-position: it needs --intensity"},
        Misuse{{"--intensity", "1", "--light", "0", "--intensity", "2"}, "--intensity: it is given twice"},
        Misuse{{"--light", "0", "--intensity", "1", "--intensity", "2"}, "--intensity: it is given twice"},
        Misuse{{"--intensity", "1", "--light", "0", "--sun", "0,1,0", "--irradiance", "2"},
               "--intensity: it stands before the lights, and is none's"},
        Misuse{{"--sun", "0,1,0"}, "--sun: it needs --irradiance"},
        Misuse{{"--sun-angles", "0,40"}, "--sun-angles: it needs --irradiance"},
        Misuse{{"--sun", "0,1,0", "--sun-angles", "0,40", "--irradiance", "1"},
               "--sun: it needs --irradiance"},
        Misuse{{"--sun-angles", "0,40", "--irradiance", "1", "--light-position", "0,1,0"},
               "--light-position: it needs --intensity"},
        Misuse{{"--light-position", "0,1,0", "--intensity", "1", "--irradiance", "1"},
               "--light-position: --irradiance contradicts it"},
        Misuse{{"--sun", "0,1,0", "--intensity", "1"}, "--intensity: --sun contradicts it"},
        Misuse{{"--irradiance", "1"}, "--irradiance: the light is a lamp, which has no irradiance"},
        Misuse{{"render", "nave", "-o", "x.exr", "--intensity", "1"},
               "--intensity: the light is a sun, which has no intensity; give its irradiance"},
        Misuse{{"--sun", "0,0,0", "--irradiance", "1"}, "--sun: it has no length"},
        Misuse{{"--spot-angles", "20,30"}, "--spot-angles: the light is no spot"},
        Misuse{{"--spot-target", "0,0,0", "--spot-angles", "30,20"}, "--spot-angles: the inner half-angle"},
        Misuse{{"--spot-target", "0,0,0", "--spot-angles", "30"}, "--spot-angles: '30' is not two"},
        Misuse{{"--spot-target", "0,0"}, "--spot-target: '0,0' is not three"},
        Misuse{{"--range", "0"}, "--range: 0 is not positive"},
        Misuse{{"--sun", "0,1,0", "--irradiance", "1", "--spot-target", "0,0,0"},
               "--spot-target: --sun contradicts it"},
        Misuse{{"render", "nave", "-o", "x.exr", "--spot-target", "0,0,0"},
               "--spot-target: the light is a sun, which has no target"},
        Misuse{{"render", "nave", "-o", "x.exr", "--range", "5"},
               "--range: the light is a sun, which has no range"},
        Misuse{{"--sun", "0,1", "--irradiance", "1"}, "--sun: '0,1' is not three finite numbers"},
        Misuse{{"--sun-angles", "0,91", "--irradiance", "1"}, "--sun-angles: the elevation 91"},
        Misuse{{"--sun-angles", "40", "--irradiance", "1"}, "--sun-angles: '40' is not two"},
        Misuse{{"--sun", "0,1,0", "--irradiance=-1"}, "--irradiance: it must not be negative"},
        Misuse{{"--sun", "0,1,0", "--irradiance", "1e25", "--sigma-s", "2"}, "lower --irradiance"},
        Misuse{{"--sun", "1,0,0", "--irradiance", "1", "--fog-top", "2"}, "leave out --fog-top"},
        Misuse{{"--fog-top", "nan"}, "--fog-top"}, Misuse{{"--fog-top", "1e19"}, "--fog-top"},
        Misuse{{"--phase", "mie"}, "unknown"}, Misuse{{"--rayleigh-weight", "0.5"}, "hoffman-preetham"},
        Misuse{{"--volume", "moments"}, "march, froxel, reference"},
        Misuse{{"--surface", "silhouettes"}, "shadow-map, vsv, psv, metric-tree"},
        Misuse{{"--volume", "vsv,none"}, "one method"}, Misuse{{"--volume", ""}, "--volume"},
        Misuse{{"--volume", "vsv:integral=sum"}, "riemann"},
        Misuse{{"--volume", "vsv:shade=1"}, "integral"}));

INSTANTIATE_TEST_SUITE_P(
    Sweeps, Usage,
    testing::Values(
        Misuse{{"sweep"}, "SCENE: it is missing"}, Misuse{{"sweep", "cornell"}, "--volume: it is missing"},
        Misuse{{"sweep", "cornell", "--volume", "vsv:alpha={64,128"}, "a brace opens that none closes"},
        Misuse{{"sweep", "cornell", "--volume", "vsv:alpha=64,128}"}, "a brace closes that none opens"},
        Misuse{{"sweep", "cornell", "--volume", "vsv:alpha={64,{128}}"}, "braces within braces"},
        Misuse{{"sweep", "cornell", "--volume", "vsv:alpha={64,}"}, "a value in braces is empty"},
        Misuse{{"sweep", "cornell", "--volume", "vsv:alpha={64,zwei}"}, "'zwei' is not a whole number"},
        Misuse{{"sweep", "cornell", "--volume", "vsv:alpha={64,64}"}, "vsv:alpha=64 is there twice"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--shadow-map", "{64,0}"}, "--shadow-map"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--shadow-map", "{64"}, "--shadow-map: '{64'"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--surface", "{none,fog}"}, "'fog'"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--all"}, "--all"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--frames", "0"}, "--frames"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--shard", "0/2"}, "--shard"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--shard", "3/2"}, "no shard 3 of 2"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--shard", "2"}, "'2' is not K/N"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--baseline", "vsv,none"}, "--baseline"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--baseline", "fog"}, "'fog'"},
        Misuse{{"sweep", "cornell", "--volume", "vsv", "--max-error", "1"}, "no such option"},
        Misuse{{"sweep", "cornell", "--volume", "reference", "--alpha", "64"}, "--alpha: none of"}));

/// What is meant for methods, where none of those chosen looks at it.
INSTANTIATE_TEST_SUITE_P(
    Unread, Usage,
    testing::Values(
        Misuse{{"--volume", "reference", "--integral", "table"}, "--integral: none of the methods chosen"},
        Misuse{{"--volume", "none", "--surface", "vsv", "--integral", "table"},
               "one that does: --volume vsv"},
        Misuse{{"--volume", "none", "--alpha", "64"}, "(--volume none, --surface shadow-map)"},
        Misuse{{"--volume", "none", "--theta", "64"}, "--volume vsv, --surface vsv"},
        Misuse{{"--volume", "none", "--phi", "128"}, "--phi"},
        Misuse{{"--volume", "none", "--surface", "none", "--shadow-map", "64"}, "--shadow-map"},
        Misuse{{"--volume", "vsv:populate=conservative", "--surface", "none", "--shadow-map", "64"},
               "--shadow-map"},
        Misuse{{"compare", "cornell", "--volume", "reference-march,reference", "--populate", "conservative"},
               "--populate"}));

using BadFile = CommandLine;

TEST_F(BadFile, MissingSceneIsNamed) {
  for (const char* scene :
       {"nosuch", "nosuch.glb", "nosuch.obj", "nosuch.ply", "nosuch.toml", "nosuch.xyz"}) {
    const Result result = airlight({"render", scene, "-o", "x.exr"});
    expect_one_line_error(result, 3);
    EXPECT_THAT(result.err, HasSubstr(scene));
  }
}

TEST_F(BadFile, UnwritableOutputIsFoundBeforeTheWork) {
  // An image of this size would take longer than these tests wait.
  const Words huge = {"--size", "8192x8192", "--volume", "reference"};
  for (Words words : {Words{"render", "window", "-o", "/dev/null/x.exr"},
                      {"render", "window", "-o", "/dev/null/folder/x.exr"},
                      {"compare", "window", "-o", "/dev/null/x"},
                      {"compare", "window", "-o", "out", "--json", "no/x"}}) {
    words.insert(words.end(), huge.begin(), huge.end());
    expect_one_line_error(airlight(words), 3);
  }
}

TEST_F(BadFile, FullDiskIsAnError) {
  const Result result =
      small({"compare", "cornell", "-o", "out", "--volume", "vsv", "--frames", "1", "--json", "/dev/full"});
  expect_one_line_error(result, 3);
  EXPECT_THAT(result.err, HasSubstr("/dev/full"));
}

TEST_F(BadFile, LightAtTheEyeIsRefused) {
  const Result result = airlight({"render", "cornell", "-o", "x.exr", "--eye", "0,1,2", "--target", "0,1,0",
                                  "--light-position", "0,1,2", "--intensity", "1"});
  expect_one_line_error(result, 3);
  EXPECT_THAT(result.err, HasSubstr("infinite"));
}

using Driver = CommandLine;

TEST_F(Driver, ImageOverTheLimitNamesIt) {
  const Result result = airlight({"render", "cornell", "-o", "x.exr", "--size", "1000000x8"});
  expect_one_line_error(result, 4);
  EXPECT_THAT(result.err, HasSubstr("GL_MAX_TEXTURE_SIZE"));
  expect_one_line_error(airlight({"compare", "cornell", "-o", "out", "--size", "1000000x8"}), 4);
  // More triangles than turns after which a driver ends a loop.
  expect_one_line_error(airlight({"compare", "spheres", "-o", "out", "--size", "8x8", "--volume", "none",
                                  "--surface", "brute"}),
                        4);
}

TEST_F(Driver, GridOverTheLimitNamesIt) {
  const Result result = small({"compare", "cornell", "-o", "out", "--alpha", "131072", "--theta", "131072"});
  expect_one_line_error(result, 4);
  EXPECT_THAT(result.err, HasSubstr("GL_MAX_TEXTURE_BUFFER_SIZE"));
}

TEST_F(Driver, ShadowMapOverTheLimitNamesIt) {
  const Result result = small({"render", "cornell", "-o", "x.exr", "--shadow-map", "1000000"});
  expect_one_line_error(result, 4);
  EXPECT_THAT(result.err, HasSubstr("GL_MAX_TEXTURE_SIZE"));
}

using Render = CommandLine;

TEST_F(Render, WritesChannelsAndPreview) {
  const Image image = render({"--size", "40x24"});
  EXPECT_EQ(image.size, glm::ivec2(40, 24));
  Words names;
  for (const auto& channel : image.channels) names.push_back(channel.first);
  EXPECT_THAT(names, testing::UnorderedElementsAre("R", "G", "B", "airlight.R", "airlight.G", "airlight.B",
                                                   "surface.Y", "distance.Y"));
  EXPECT_THAT(read_text(file("image.png")), StartsWith("\x89PNG"));
}

TEST_F(Render, MakesTheFolderOfItsImage) {
  const Result result = small({"render", "cornell", "-o", "a/b/x.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(file("a/b/x.exr")) && fs::exists(file("a/b/x.png")));
}

TEST_F(Render, SaysNothingOnStandardOutput) {
  const Result talks = small({"render", "cornell", "-o", "x.exr"});
  EXPECT_THAT(talks.out, IsEmpty());
  EXPECT_THAT(talks.err, HasSubstr("x.exr"));
  const Result silent = small({"render", "cornell", "-o", "x.exr", "--quiet"});
  EXPECT_THAT(silent.out + silent.err, IsEmpty());
}

TEST_F(Render, KeepsItsConfigurationSoThatItCanBeRepeated) {
  const Image image = render({"--sigma-s", "0.2,0.3,0.4", "--phase", "henyey-greenstein", "--g", "0.3",
                              "--fov", "50", "--volume", "vsv:integral=riemann"});
  const auto text = [&](const std::string& name) { return image.metadata.at("airlight." + name); };
  EXPECT_EQ(text("scene"), "cornell");
  EXPECT_EQ(text("sigma-s"), "0.2,0.3,0.4");
  EXPECT_EQ(text("sigma-a"), "0,0,0");
  EXPECT_EQ(text("g"), "0.3");
  EXPECT_EQ(text("fov"), "50");
  EXPECT_EQ(text("integral"), "riemann");
  EXPECT_EQ(text("alpha"), "64");
  EXPECT_EQ(text("shadow-map"), "128");

  // By the command.
  const std::string command = text("command");
  ASSERT_THAT(command, StartsWith("airlight render cornell"));
  EXPECT_EQ(shell(quality::shell_quote(AIRLIGHT_BINARY) + command.substr(8)).exit_code, 0);
  EXPECT_EQ(quality::read_exr(file("image.exr")).channels, image.channels);

  // By the options.
  Words words;
  for (const char* name :
       {"eye", "target", "up", "fov", "light-position", "intensity", "sigma-s", "sigma-a", "phase", "g",
        "size", "volume", "surface", "alpha", "theta", "phi", "shadow-map"}) {
    words.push_back(fmt::format("--{}", name));
    words.push_back(text(name));
  }
  EXPECT_EQ(render(words).channels, image.channels);
}

TEST_F(Render, HoffmanPreethamIsAMixOfTwoPhaseFunctions) {
  const auto airlight = [&](const Words& words) {
    const Image image = render(words);
    return mean(image.channels.at("airlight.G"));
  };
  const double rayleigh = airlight({"--phase", "rayleigh"});
  const double lobe = airlight({"--phase", "henyey-greenstein", "--g", "0.6"});
  ASSERT_GT(std::abs(rayleigh / lobe - 1), 0.1);
  const Words mix = {"--phase", "hoffman-preetham", "--g", "0.6"};
  // Cells in φ grow with the phase function, and with them the bits differ a little.
  EXPECT_NEAR(airlight(mix) / (0.5 * rayleigh + 0.5 * lobe), 1.0, 1e-2);
  Words hazy = mix;
  hazy.insert(hazy.end(), {"--rayleigh-weight", "0.1"});
  EXPECT_NEAR(airlight(hazy) / (0.1 * rayleigh + 0.9 * lobe), 1.0, 1e-2);
  EXPECT_EQ(quality::read_exr(file("image.exr")).metadata.at("airlight.rayleigh-weight"), "0.1");
}

TEST_F(Render, MethodsNoneMeanNoAirlightAndNoShadow) {
  const Image image = render({"--volume", "none", "--surface", "none"});
  EXPECT_EQ(mean(image.channels.at("airlight.G")), 0.0);
  for (std::size_t i = 0; i < image.channels.at("distance.Y").size(); ++i) {
    EXPECT_EQ(image.channels.at("surface.Y")[i], image.channels.at("distance.Y")[i] > 0.0f ? 1.0f : 0.0f);
  }
  EXPECT_GT(mean(image.channels.at("G")), 0.0);
}

TEST_F(Render, ReferenceMethodsAgreeWithEachOther) {
  const Image exact = render({"--volume", "reference", "--surface", "reference"});
  for (const char* volume :
       {"reference-march", "reference-march:rays=single:steps=256", "reference-sampled:samples=32"}) {
    const Image other = render({"--volume", volume, "--surface", "reference"});
    EXPECT_NEAR(mean(other.channels.at("airlight.G")) / mean(exact.channels.at("airlight.G")), 1.0, 2e-3)
        << volume;
    EXPECT_EQ(other.channels.at("surface.Y"), exact.channels.at("surface.Y"));
  }
}

TEST_F(Render, BlackSurfacesLeaveTheAirlightAlone) {
  const Image image = render({"--albedo", "0"});
  EXPECT_EQ(image.channels.at("R"), image.channels.at("airlight.R"));
  EXPECT_NE(render({}).channels.at("R"), image.channels.at("airlight.R"));
}

TEST_F(Render, LightAndMediumOptionsScaleTheAirlight) {
  const Words base = {"empty", "--volume", "reference", "--surface", "none"};
  const auto green = [&](const Words& more) {
    Words words = base;
    words.insert(words.end(), more.begin(), more.end());
    return mean(render(words).channels.at("airlight.G"));
  };
  const double plain = green({"--intensity", "1", "--sigma-s", "0.001"});
  EXPECT_NEAR(green({"--intensity", "5,3,5", "--sigma-s", "0.001"}) / plain, 3.0, 1e-3);
  // In thin fog the airlight grows with the scattering coefficient, and absorption weakens it.
  EXPECT_NEAR(green({"--intensity", "1", "--sigma-s", "0.001,0.002,0.003"}) / plain, 2.0, 0.1);
  EXPECT_LT(green({"--intensity", "1", "--sigma-s", "0.001", "--sigma-a", "0.1"}), 0.9 * plain);
  EXPECT_NE(green({"--intensity", "1", "--sigma-s", "0.001", "--phase", "rayleigh"}), plain);
  EXPECT_NE(green({"--light-position", "1,1,1", "--intensity", "1", "--sigma-s", "0.001"}), plain);
}

TEST_F(Render, ASpotLightsWhatItIsAimedAt) {
  const auto image_of = [&](Words words) {
    words.insert(words.end(), {"--volume", "reference", "--surface", "none"});
    return render(words);
  };
  const Image lamp = image_of({});
  const Image image = image_of({"--spot-angles", "20,30", "--spot-target", "-1,0.5,0", "--range", "3",
                                "--light-position", "0,1.85,0", "--intensity", "1,0.86,0.68"});
  for (const char* channel : {"R", "airlight.R"}) {
    EXPECT_LT(mean(image.channels.at(channel)), 0.3 * mean(lamp.channels.at(channel)));
    EXPECT_GT(mean(image.channels.at(channel)), 0.01 * mean(lamp.channels.at(channel)));
  }
  EXPECT_EQ(image.channels.at("surface.Y"), lamp.channels.at("surface.Y")) << "it is what occluders leave";
  EXPECT_EQ(image.metadata.at("airlight.spot-angles"), "20,30");
  EXPECT_EQ(image.metadata.at("airlight.range"), "3");
  const auto at = [&](const char* option) { return image.metadata.at(fmt::format("airlight.{}", option)); };
  const Image again =
      image_of({"--light-position", at("light-position"), "--intensity", at("intensity"), "--spot-target",
                at("spot-target"), "--spot-angles", at("spot-angles"), "--range", at("range")});
  EXPECT_EQ(again.channels, image.channels);

  std::ofstream(file("spot.toml")) << "scene = 'cornell'\n[light]\ntarget = [-1, 0.5, 0]\nangles = [20, "
                                      "30]\nrange = 3\n";
  EXPECT_EQ(image_of({"spot.toml"}).channels.at("airlight.R"), image.channels.at("airlight.R"));
}

TEST_F(Render, CameraOptionsMoveTheView) {
  const auto distance = [&](const Words& words) { return render(words).channels.at("distance.Y"); };
  const auto own = distance({});
  EXPECT_EQ(distance({"--camera", "front"}), own);
  EXPECT_EQ(distance({"--camera", "0"}), own);
  EXPECT_EQ(distance({"--eye", "0,1,4.2", "--target", "0,1,0", "--fov", "38"}), own);
  EXPECT_NE(distance({"--fov", "60"}), own);
  EXPECT_NE(distance({"--eye", "-0.5,1,4.2", "--target", "0,1,0", "--fov", "38"}), own);
  EXPECT_NE(distance({"--up", "1,0,0"}), own);
}

TEST_F(Render, TrianglesSetTheDetailOfAScene) {
  const Image coarse = render({"spheres", "--triangles", "2000"});
  EXPECT_NE(coarse.channels, render({"spheres", "--triangles", "8000"}).channels);
  EXPECT_EQ(render({"toroid", "--triangles", "50000"}).channels, render({"toroid"}).channels);
}

TEST_F(Render, ExposureIsThatOfThePreviewAlone) {
  const Image dark = render({"--exposure", "0.1"});
  const std::string dark_preview = read_text(file("image.png"));
  const Image bright = render({"--exposure", "10"});
  EXPECT_NE(read_text(file("image.png")), dark_preview);
  EXPECT_EQ(dark.channels, bright.channels);
  EXPECT_EQ(bright.metadata.at("airlight.exposure"), "10");
}

TEST_F(Render, ToneMapIsThatOfThePreviewAlone) {
  const Image plain = render({"--exposure", "4"});
  std::set<std::string> previews = {read_text(file("image.png"))};
  for (const char* name : {"reinhard", "aces", "agx"}) {
    const Image image = render({"--exposure", "4", "--tone-map", name});
    EXPECT_EQ(image.channels, plain.channels);
    EXPECT_EQ(image.metadata.at("airlight.tone-map"), name);
    previews.insert(read_text(file("image.png")));
  }
  EXPECT_EQ(previews.size(), 4u);
}

TEST_F(Render, SurroundingsAddToTheImageAndNotToTheAirlight) {
  const Image plain = render({});
  const Image lit = render({"--ambient", "0.1,0.2,0.3"});
  EXPECT_GT(mean(lit.channels.at("B")), mean(plain.channels.at("B")));
  EXPECT_EQ(lit.channels.at("airlight.B"), plain.channels.at("airlight.B"));
  EXPECT_EQ(lit.metadata.at("airlight.ambient"), "0.1,0.2,0.3");
  const Image fitted = render({"--ambient", "auto"});
  EXPECT_GT(mean(fitted.channels.at("R")), mean(plain.channels.at("R")));
  EXPECT_EQ(render({"--ambient", fitted.metadata.at("airlight.ambient")}).channels, fitted.channels);

  const Words sky = {"empty", "--fog-top", "20", "--background", "0,0,1"};
  EXPECT_GT(mean(render(sky).channels.at("B")), mean(render({"empty", "--fog-top", "20"}).channels.at("B")));
  std::ofstream(file("sky.toml"))
      << "scene = 'empty'\nbackground = [0, 0, 1]\ntone_map = 'agx'\n[medium]\nfog_top = 20\n";
  EXPECT_EQ(render({"sky.toml"}).channels, render(sky).channels);
}

TEST_F(Render, ShowsModelsTexturedUnlessToldOtherwise) {
  std::ofstream(file("m.mtl")) << "newmtl m\nKd 1 1 1\nmap_Kd red.png\n";
  std::ofstream(file("m.obj")) << "mtllib m.mtl\nv -9 -9 -3\nv 9 -9 -3\nv 0 9 -3\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                  "usemtl m\nf 1/1 2/2 3/3\n";
  quality::write_png(file("red.png"), std::vector<glm::vec3>{{1, 0, 0}}, {1, 1}, 1.0f);
  const auto view = [](Words words) {
    words.insert(words.begin(), "m.obj");
    words.insert(words.end(),
                 {"--eye", "0,0,1", "--target", "0,0,-3", "--light-position", "0,2,1", "--intensity", "9"});
    return words;
  };
  const Image textured = render(view({})), flat = render(view({"--looks", "flat"}));
  EXPECT_EQ(textured.channels.at("R"), flat.channels.at("R"));
  EXPECT_EQ(textured.channels.at("G"), textured.channels.at("airlight.G"));
  EXPECT_NE(flat.channels.at("G"), flat.channels.at("airlight.G"));
  for (const char* channel : {"airlight.R", "airlight.G", "surface.Y", "distance.Y"})
    EXPECT_EQ(textured.channels.at(channel), flat.channels.at(channel)) << channel;

  fs::remove(file("red.png"));
  const auto words = [&](const char* command, Words more) {
    more.insert(more.begin(), command);
    more.insert(more.end(), {"-o", std::string(command) == "render" ? "x.exr" : "x"});
    return more;
  };
  const Result missing = small(words("render", view({})));
  expect_one_line_error(missing, 3);
  EXPECT_THAT(missing.err, HasSubstr("material 'm', texture: red.png: there is no such file"));
  // compare asks for what methods compute alone.
  EXPECT_EQ(small(words("compare", view({"--volume", "vsv", "--frames", "1"}))).exit_code, 0);
  expect_one_line_error(small(words("compare", view({"--volume", "vsv", "--looks", "textured"}))), 3);
}

/// A light texture, green towards +X and red towards −X.
class TexturedLight : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    quality::write_exr(file("light.exr"),
                       {.size = {4, 1},
                        .channels = {{"R", {0, 0, 1, 1}}, {"G", {1, 1, 0, 0}}, {"B", {0, 0, 0, 0}}},
                        .metadata = {}});
  }
};

TEST_F(TexturedLight, ColoursTheImageInEveryMethodByDefault) {
  const Image image = render({"--light-texture", "light.exr"});
  EXPECT_EQ(image.metadata.at("airlight.light-texture"), "light.exr");
  EXPECT_EQ(image.metadata.at("airlight.integral"), "quadrature");
  EXPECT_EQ(mean(image.channels.at("B")), 0.0);
  // The light hangs in the middle of the room, and the camera looks along −Z: +X is to the right.
  for (const char* channel : {"", "airlight."}) {
    const auto sum = [&](const char* colour, bool right) {
      double result = 0.0;
      for (int i = 0; i < 32 * 32; ++i) {
        if ((i % 32 >= 16) == right)
          result += static_cast<double>(
              image.channels.at(std::string(channel) + colour)[static_cast<std::size_t>(i)]);
      }
      return result;
    };
    EXPECT_GT(sum("G", true), 1.5 * sum("R", true));
    EXPECT_GT(sum("R", false), 1.5 * sum("G", false));
  }
  for (const char* volume : {"reference", "reference-march"}) {
    const Image other = render({"--light-texture", "light.exr", "--volume", volume});
    EXPECT_NEAR(mean(other.channels.at("airlight.G")) / mean(image.channels.at("airlight.G")), 1.0, 0.02);
  }
}

TEST_F(TexturedLight, IsComparedByTheMethodsThatCanTakeIt) {
  const Json results = compare({"--light-texture", "light.exr"});
  ASSERT_EQ(results["runs"].size(), 3u);
  EXPECT_EQ(results["runs"][0]["volume"], "vsv");
  EXPECT_EQ(results["runs"][0]["settings"]["integral"], "quadrature");
  EXPECT_EQ(results["runs"][1]["volume"], "vsv:integral=riemann");
  EXPECT_EQ(results["runs"][2]["volume"], "reference-march");
  EXPECT_LT(results["runs"][0]["error"]["airlight"]["rrmse"], 0.1);
  EXPECT_EQ(results["view"]["lights"][0]["texture"], "light.exr");
  EXPECT_THAT(tests::schema_violations(results, Json::parse(read_text(AIRLIGHT_SCHEMA))), IsEmpty());
  EXPECT_THAT(read_text(file("out/report.html")), HasSubstr("textured by light.exr"));
}

TEST_F(TexturedLight, OfAShotIsThatOfTheOption) {
  fs::create_directory(file("shots"));
  std::ofstream(file("shots/lantern.toml")) << "scene = 'cornell'\n[light]\ntexture = '../light.exr'\n";
  const Image shot = render({"shots/lantern.toml", "--volume", "vsv"});
  EXPECT_EQ(shot.channels, render({"--light-texture", "light.exr"}).channels);
  // As seen from where the program ran.
  EXPECT_EQ(shot.metadata.at("airlight.light-texture"), "shots/../light.exr");

  std::ofstream(file("dark.toml")) << "scene = 'cornell'\n[light]\ntexture = 'nosuch.exr'\n";
  const Result result = airlight({"render", "dark.toml", "-o", "x.exr"});
  expect_one_line_error(result, 3);
  EXPECT_THAT(result.err, HasSubstr("dark.toml, line 3, light.texture: nosuch.exr"));
}

TEST_F(TexturedLight, IsRefusedByTheOthersBeforeTheDriverIsWoken) {
  for (const Words& words : {Words{"--volume", "vsv:integral=table"},
                             {"--volume", "vsv:integral=factored"},
                             {"--integral", "table"},
                             {"--integral", "factored"}}) {
    // The driver would refuse this size.
    Words all = {"render", "cornell", "-o", "x.exr", "--size", "1000000x8", "--light-texture", "light.exr"};
    all.insert(all.end(), words.begin(), words.end());
    const Result result = airlight(all);
    expect_one_line_error(result, 2);
    EXPECT_THAT(result.err, HasSubstr("integral=quadrature"));
    all[0] = "compare";
    expect_one_line_error(airlight(all), 2);
  }
}

TEST_F(TexturedLight, ThatCannotBeReadIsNamed) {
  std::ofstream(file("text.exr")) << "no image";
  quality::write_exr(file("grey.exr"), {.size = {1, 1}, .channels = {{"Y", {1}}}, .metadata = {}});
  quality::write_exr(file("negative.exr"),
                     {.size = {1, 1}, .channels = {{"R", {1}}, {"G", {-1}}, {"B", {1}}}, .metadata = {}});
  for (const char* name : {"nosuch.exr", "text.exr", "grey.exr", "negative.exr"}) {
    const Result result = airlight({"render", "cornell", "-o", "x.exr", "--light-texture", name});
    expect_one_line_error(result, 3);
    EXPECT_THAT(result.err, HasSubstr(name));
  }
}

/// A file without camera and light, with one good triangle and one of no area.
class SceneFile : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    std::ofstream(file("two.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n";
  }
  const Words light_ = {"--light-position", "1,1,2", "--intensity", "1"};
};

TEST_F(SceneFile, WithoutLightIsAnErrorThatSaysHowToGiveOne) {
  const Result result = airlight({"render", "two.obj", "-o", "x.exr"});
  expect_one_line_error(result, 2);
  EXPECT_THAT(result.err, HasSubstr("--light-position"));
  EXPECT_THAT(result.err, HasSubstr("--sun"));
}

TEST_F(SceneFile, WithoutCameraIsFittedAndExposedAutomatically) {
  Words words = {"render", "two.obj", "-o", "x.exr"};
  words.insert(words.end(), light_.begin(), light_.end());
  const Result result = small(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("automatic"));
  EXPECT_GT(mean(quality::read_exr(file("x.exr")).channels.at("distance.Y")), 0.0);
}

TEST_F(SceneFile, WarningsReachStandardErrorAndTheResults) {
  Words words = {"compare", "two.obj", "-o", "out", "--volume", "vsv", "--frames", "1"};
  words.insert(words.end(), light_.begin(), light_.end());
  const Result result = small(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("zero area dropped: 1"));
  EXPECT_EQ(Json::parse(read_text(file("out/results.json")))["scene"]["degenerate_triangles"], 1);
  words.push_back("--quiet");
  EXPECT_THAT(small(words).err, IsEmpty());
}

/// A shot of `cornell` that says everything.
class ShotFile : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    std::ofstream(file("all.toml")) << "scene = 'cornell'\nexposure = 3\nalbedo = 0.5\n"
                                       "[camera]\neye = [0.2, 1, 3]\ntarget = [0, 1, 0]\nfov = 50\n"
                                       "[light]\nposition = [0.3, 1.5, 0]\nintensity = [2, 1, 0.5]\n"
                                       "[medium]\nsigma_s = 0.2\nsigma_a = [0, 0.1, 0.2]\n"
                                       "phase = 'henyey-greenstein'\ng = 0.3\n";
  }
};

TEST_F(ShotFile, MeansWhatTheOptionsOfItsKeysMean) {
  const Image shot = render({"all.toml"});
  EXPECT_EQ(shot.metadata.at("airlight.exposure"), "3");
  const Image options = render({"cornell",
                                "--albedo",
                                "0.5",
                                "--eye",
                                "0.2,1,3",
                                "--target",
                                "0,1,0",
                                "--fov",
                                "50",
                                "--light-position",
                                "0.3,1.5,0",
                                "--intensity",
                                "2,1,0.5",
                                "--sigma-s",
                                "0.2",
                                "--sigma-a",
                                "0,0.1,0.2",
                                "--phase",
                                "henyey-greenstein",
                                "--g",
                                "0.3"});
  EXPECT_EQ(shot.channels, options.channels);
}

TEST_F(ShotFile, OptionsOverrideIt) {
  const Image shot = render({"all.toml", "--camera", "front", "--light", "ceiling", "--intensity",
                             "1,0.86,0.68", "--sigma-s", "0.25", "--sigma-a", "0", "--phase", "isotropic",
                             "--albedo", "0", "--exposure", "7"});
  EXPECT_EQ(shot.metadata.at("airlight.exposure"), "7");
  EXPECT_EQ(shot.channels, render({"cornell", "--albedo", "0"}).channels);
}

TEST_F(ShotFile, ErrorNamesFileAndLine) {
  std::ofstream(file("bad.toml")) << "scene = 'cornell'\nfog = 1\n";
  const Result result = airlight({"render", "bad.toml", "-o", "x.exr"});
  expect_one_line_error(result, 3);
  EXPECT_THAT(result.err, HasSubstr("bad.toml, line 2: there is no key 'fog'"));
  expect_one_line_error(airlight({"render", "all.toml", "-o", "x.exr", "--triangles", "5000"}), 2);
}

TEST_F(ShotFile, OfSeveralMethodsIsNotRendered) {
  std::ofstream(file("several.toml")) << "scene = 'cornell'\n[methods]\nvolume = 'vsv,march'\n";
  const Result result = airlight({"render", "several.toml", "-o", "x.exr"});
  expect_one_line_error(result, 2);
  EXPECT_THAT(result.err, HasSubstr("render takes one method"));
}

TEST_F(ShotFile, OfTheProjectIsRendered) {
  for (const auto& entry : fs::directory_iterator(AIRLIGHT_ASSETS)) {
    if (entry.path().extension() != ".toml") continue;
    const Image image = render({entry.path().string()});
    EXPECT_GT(mean(image.channels.at("airlight.G")), 0.0) << entry.path();
  }
}

/// A lamp and a sun beside the lamp of `cornell`, each with options of its own.
class SeveralLights : public CommandLine {
 protected:
  const Words second_ = {"--light-position", "0.5,1.4,0.3", "--intensity", "0.2,0.3,0.9"};
  const Words sun_ = {"--sun", "0.2,0.5,1", "--irradiance", "2,1.5,1"};

  static Words joined(std::initializer_list<Words> lists) {
    Words all;
    for (const Words& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
  }
};

TEST_F(SeveralLights, AddUpAndHaveChannelsOfTheirOwn) {
  const Image all = render(joined({{"--light", "ceiling", "--intensity", "0.5"}, second_, sun_}));
  const Image one = render({"--intensity", "0.5"}), two = render(second_), three = render(sun_);
  EXPECT_EQ(all.channels.size(), 8u + 3 * 4u);
  EXPECT_EQ(one.channels.size(), 8u);
  for (const std::string channel : {"R", "G", "B"}) {
    for (const std::string prefix : {"", "airlight."}) {
      const std::string name = prefix + channel;
      for (std::size_t i = 0; i < all.channels.at(name).size(); ++i) {
        const float sum = one.channels.at(name)[i] + two.channels.at(name)[i] + three.channels.at(name)[i];
        ASSERT_NEAR(all.channels.at(name)[i], sum, 1e-6f * sum) << name << " " << i;
      }
    }
    EXPECT_EQ(all.channels.at("airlight.ceiling." + channel), one.channels.at("airlight." + channel));
    EXPECT_EQ(all.channels.at("airlight.light1." + channel), two.channels.at("airlight." + channel));
    EXPECT_EQ(all.channels.at("airlight.light2." + channel), three.channels.at("airlight." + channel));
  }
  EXPECT_EQ(all.channels.at("surface.ceiling.Y"), one.channels.at("surface.Y"));
  EXPECT_EQ(all.channels.at("surface.light2.Y"), three.channels.at("surface.Y"));
  EXPECT_EQ(all.metadata.at("airlight.light.light1.intensity"), "0.2,0.3,0.9");
}

TEST_F(SeveralLights, AreRepeatedByTheirCommand) {
  const Image image = render(joined({sun_, {"--light", "ceiling"}, second_}));
  const std::string command = image.metadata.at("airlight.command");
  EXPECT_THAT(command, HasSubstr("--sun 0.2,0.5,1 --irradiance 2,1.5,1 --light ceiling --light-position "
                                 "0.5,1.4,0.3 --intensity 0.2,0.3,0.9"));
  EXPECT_EQ(shell(quality::shell_quote(AIRLIGHT_BINARY) + command.substr(8)).exit_code, 0);
  EXPECT_EQ(quality::read_exr(file("image.exr")).channels, image.channels);
}

TEST_F(SeveralLights, OfAShotAreAllOnUnlessChosen) {
  std::ofstream(file("two.toml")) << "scene = 'cornell'\n[[light]]\nname = 'ceiling'\n"
                                     "[[light]]\nposition = [0.5, 1.4, 0.3]\nintensity = [0.2, 0.3, 0.9]\n";
  const Image both = render({"two.toml"});
  EXPECT_EQ(both.channels, render(joined({{"--light", "all"}, second_})).channels);
  EXPECT_EQ(both.channels, render({"two.toml", "--light", "all"}).channels);
  EXPECT_EQ(render({"two.toml", "--light", "light1"}).channels, render(second_).channels);
  EXPECT_EQ(render({"two.toml", "--intensity", "2", "--light", "0"}).channels,
            render({"--intensity", "2"}).channels)
      << "of one light the options may stand before it";
  const Result unsaid = airlight({"render", "two.toml", "-o", "x.exr", "--intensity", "1"});
  expect_one_line_error(unsaid, 2);
  EXPECT_THAT(unsaid.err,
              HasSubstr("--intensity: the scene has several lights, 'ceiling' (0), 'light1' (1); say"));
}

TEST_F(SeveralLights, ThatCannotReachTheViewAreSkippedAndSaidToBe) {
  const Words words = {"--light", "ceiling", "--light-position", "0,0,2000", "--intensity", "1"};
  const Image image = render(words);
  EXPECT_EQ(image.metadata.at("airlight.skipped-lights"), "light1");
  EXPECT_EQ(image.channels.at("R"), render({}).channels.at("R"));
  const Json results = compare(joined({{"--volume", "vsv,reference"}, words}));
  EXPECT_EQ(results["runs"][0]["skipped_lights"], 1);
  EXPECT_EQ(results["runs"][0]["lights"][1]["skipped"], true);
  EXPECT_EQ(results["runs"][1]["skipped_lights"], 0) << "the truth sees every light";
  EXPECT_EQ(2 * results["runs"][0]["error"]["surface"]["pixels"].get<int>(),
            results["runs"][1]["error"]["surface"]["pixels"].get<int>());
}

TEST_F(SeveralLights, AreComparedTogether) {
  const Words lights = joined({{"--light", "0"}, second_, sun_});
  const Json results = compare(joined({{"--volume", "vsv,reference", "--cache", "kept", "--debug"}, lights}));
  EXPECT_THAT(tests::schema_violations(results, Json::parse(read_text(AIRLIGHT_SCHEMA))), IsEmpty());
  ASSERT_EQ(results["view"]["lights"].size(), 3u);
  EXPECT_EQ(results["view"]["lights"][2]["name"], "light2");
  const Json& vsv = results["runs"][0];
  EXPECT_LT(vsv["error"]["airlight"]["rrmse"], 0.1);
  EXPECT_EQ(vsv["debug_images"].size(), 3 * 4u);
  for (const Json& light : vsv["lights"]) EXPECT_TRUE(light["stages_ms"].contains("integrate"));
  EXPECT_EQ(results["runs"][1]["error"]["airlight"]["rrmse"], 0.0);
  EXPECT_TRUE(fs::exists(file("out/vsv+shadow-map_grid_after_scan_2.exr")));
  EXPECT_TRUE(quality::read_exr(file("out/reference.exr")).channels.contains("airlight.light2.G"));

  // A light's truth is the same whatever shines beside it: nothing is traced, and nothing kept, a second
  // time.
  const auto kept = std::distance(fs::directory_iterator(file("kept")), fs::directory_iterator());
  const Json alone = compare(joined({{"--volume", "vsv", "--cache", "kept"}, second_}));
  EXPECT_EQ(std::distance(fs::directory_iterator(file("kept")), fs::directory_iterator()), kept + 1)
      << "distances are those around a view's first light";

  const std::string command = vsv["command"];
  EXPECT_EQ(shell(quality::shell_quote(AIRLIGHT_BINARY) + command.substr(8)).exit_code, 0) << command;
  const Json again = Json::parse(read_text(file("out/vsv+shadow-map/results.json")));
  EXPECT_EQ(again["view"], results["view"]);
  EXPECT_EQ(again["runs"][0]["error"], vsv["error"]);
}

using Compare = CommandLine;

TEST_F(Compare, ResultsFollowTheirSchema) {
  const Json schema = Json::parse(read_text(AIRLIGHT_SCHEMA));
  const Json results = compare(
      {"--volume",
       "none,vsv,vsv:integral=riemann:populate=conservative,vsv:integral=factored:scan=fused:phi-cells=equal,"
       "vsv:populate=screen-space:scan=multi-pass,reference,reference-march:steps=64,"
       "reference-march:steps=64:rays=single",
       "--surface", "none,shadow-map,vsv,psv,metric-tree,brute,reference", "--debug"});
  EXPECT_THAT(tests::schema_violations(results, schema), IsEmpty());
  EXPECT_EQ(results["runs"].size(), 56u);

  // Every field of a view is documented.
  const Json& view = schema.at("properties").at("view").at("properties");
  scene::View whole, sunny;
  whole.lights[0].texture =
      std::make_shared<const scene::LightTexture>("", glm::ivec2(1), std::vector<glm::vec3>(1));
  whole.lights[0].cone.emplace();
  whole.lights[0].range = 1;
  whole.medium = {.phase = scene::PhaseFunction::hoffman_preetham, .top = 1.0};
  sunny.lights = {scene::sun("", {0, 1, 0}, glm::vec3(1.0f))};
  const Json& light = view.at("lights").at("items").at("properties");
  for (const scene::View& shown : {whole, sunny}) {
    for_each_value(shown.lights[0], [&](const scene::FieldInfo& field, const scene::FieldValue&) {
      EXPECT_TRUE(light.contains(field.key())) << field.name;
    });
    for_each_value_of_view(
        shown, [&](std::string_view part, const scene::FieldInfo& field, const scene::FieldValue&) {
          const Json& group = part.empty() ? view : view.at(std::string(part)).at("properties");
          EXPECT_TRUE(group.contains(field.key())) << field.name;
        });
  }

  // The check itself sees what is missing, what is not documented, and what is of the wrong type.
  Json broken = results;
  broken["runs"][0].erase("frame_ms");
  broken["runs"][1]["mood"] = "good";
  broken["reference"]["samples"] = "many";
  EXPECT_EQ(tests::schema_violations(broken, schema).size(), 3u);
}

TEST_F(Compare, WritesEveryImageAndTheReport) {
  const Json results = compare({"--volume", "vsv,vsv:integral=riemann", "--surface", "shadow-map"});
  for (const Json& run : results["runs"]) {
    const std::string name = run["name"];
    EXPECT_EQ(quality::read_exr(file("out/" + name + ".exr")).channels.size(), 8u);
    EXPECT_THAT(read_text(file("out/" + name + ".png")), StartsWith("\x89PNG"));
    EXPECT_THAT(read_text(file("out/" + name + "_error.png")), StartsWith("\x89PNG"));
    EXPECT_THAT(read_text(file("out/" + name + "_surface.png")), StartsWith("\x89PNG"));
  }
  EXPECT_EQ(quality::read_exr(file("out/reference.exr")).channels.size(), 8u);
  EXPECT_THAT(read_text(file("out/reference.png")), StartsWith("\x89PNG"));
  EXPECT_THAT(read_text(file("out/report.html")), HasSubstr("vsv:integral=riemann"));
}

TEST_F(Compare, AutomaticCountsAreAsFewAsTheErrorAllows) {
  const auto cells_for = [&](const char* limit) {
    const Json run = compare({"--alpha", "auto", "--theta", "auto", "--phi", "auto", "--volume", "vsv",
                              "--size", "48x48", "--max-error", limit})["runs"][0];
    // A sample of the truth may find a little less than there is.
    EXPECT_LT(run["error"]["airlight_same_surface"]["rrmse"].get<double>(), std::stod(limit));
    EXPECT_THAT(run["command"].get<std::string>(), HasSubstr(fmt::format("--max-error {}", limit)));
    const Json& settings = run["settings"];
    return settings["alpha"].get<double>() * settings["theta"].get<double>() * settings["phi"].get<double>();
  };
  const double for_a_fifth = cells_for("0.2"), for_a_fiftieth = cells_for("0.02");
  EXPECT_LT(for_a_fifth, 0.5 * for_a_fiftieth);
  EXPECT_LT(for_a_fiftieth, 256.0 * 1024.0 * 512.0);  // what is so without a look
  EXPECT_EQ(cells_for("0.2"), for_a_fifth);
}

TEST_F(Compare, SolidsOfOpenPartsAreWarnedOf) {
  // The half-plane is two triangles, and the blocks of the Cornell box are closed.
  const Result open = small({"compare", "half-space", "-o", "out", "--populate", "screen-space"});
  EXPECT_EQ(open.exit_code, 0) << open.err;
  EXPECT_THAT(open.err, HasSubstr("1 of 1 connected parts are open: 4 edges with one triangle"));
  const Json results = Json::parse(read_text(file("out/results.json")));
  EXPECT_THAT(results.at("scene").at("warnings").dump(), HasSubstr("4 edges with one triangle"));
  EXPECT_EQ(
      small({"compare", "cornell", "-o", "out", "--populate", "screen-space"}).err.find("parts are open"),
      std::string::npos);
  EXPECT_EQ(small({"compare", "half-space", "-o", "out"}).err.find("parts are open"), std::string::npos);
}

TEST_F(Compare, DebugAddsPicturesOfTheGrid) {
  const Json results =
      compare({"--volume", "vsv,vsv:populate=conservative:integral=riemann:alpha=48,none", "--debug"});
  const std::string report = read_text(file("out/report.html"));
  for (int i = 0; i < 2; ++i) {
    const Json& run = results["runs"][static_cast<std::size_t>(i)];
    EXPECT_THAT(run["command"], HasSubstr(" --debug"));
    std::map<std::string, Image> images;
    const std::string prefix = run["name"].get<std::string>() + "_";
    for (const Json& picture : run["debug_images"]) {
      const std::string name = picture["name"];
      EXPECT_THAT(name, StartsWith(prefix));
      EXPECT_THAT(read_text(file("out/" + name + ".png")), StartsWith("\x89PNG"));
      const Image image = quality::read_exr(file("out/" + name + ".exr"));
      const std::vector<float>& values = image.channels.at("Y");
      EXPECT_EQ(*std::max_element(values.begin(), values.end()), picture["white"]);
      EXPECT_EQ(image.metadata.at("airlight.caption"), picture["caption"]);
      EXPECT_THAT(report,
                  HasSubstr(fmt::format("<figcaption>{}; white is", picture["caption"].get<std::string>())));
      images[name.substr(prefix.size())] = image;
    }
    ASSERT_EQ(images.size(), 4u);
    const Image &before = images.at("grid_before_scan"), &after = images.at("grid_after_scan");
    EXPECT_EQ(before.size, glm::ivec2(i == 0 ? 64 : 48, 128));
    EXPECT_EQ(after.size, before.size);
    EXPECT_EQ(images.at("shadowed_samples").size, glm::ivec2(32, 32));
    // Where no sample is shadowed nothing changes. (Where one is, it may be one that the surface itself
    // hides.)
    ASSERT_EQ(images.at("changes").size, glm::ivec2(32, 32));
    int changing = 0;
    for (std::size_t pixel = 0; pixel < 32 * 32; ++pixel) {
      if (images.at("changes").channels.at("Y")[pixel] == 0.0f) continue;
      EXPECT_GT(images.at("shadowed_samples").channels.at("Y")[pixel], 0.0f) << pixel;
      ++changing;
    }
    EXPECT_GT(changing, 0);
    for (std::size_t pixel = 0; pixel < before.channels.at("Y").size(); ++pixel)
      EXPECT_GE(after.channels.at("Y")[pixel], before.channels.at("Y")[pixel]);
    EXPECT_GT(mean(after.channels.at("Y")), mean(before.channels.at("Y")));
  }
  EXPECT_FALSE(results["runs"][2].contains("debug_images"));
}

TEST_F(Compare, DebugWithoutAPictureIsAWarning) {
  const Words words = {"compare", "cornell", "-o", "out", "--volume", "none", "--frames", "1"};
  EXPECT_THAT(small(words).err, testing::Not(HasSubstr("warning")));
  Words with_debug = words;
  with_debug.push_back("--debug");
  const Result result = small(with_debug);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("warning: --debug"));
}

TEST_F(Compare, SurfaceMethodsHaveSettingsOfTheirOwn) {
  const Json run = compare({"--volume", "vsv:alpha=32", "--surface", "vsv:theta=256"})["runs"][0];
  EXPECT_EQ(run["settings"]["alpha"], 32);
  EXPECT_EQ(run["settings"]["theta"], 128);
  EXPECT_EQ(run["surface_settings"]["alpha"], 64);
  EXPECT_EQ(run["surface_settings"]["theta"], 256);
  EXPECT_EQ(run["bytes"]["grid"], 32 * 128 * 128 / 8 + 64 * 256 * 128 / 8);
  const Image image = render({"--volume", "vsv:alpha=32", "--surface", "vsv:theta=256"});
  EXPECT_EQ(image.metadata.at("airlight.alpha"), "32");
  EXPECT_EQ(image.metadata.at("airlight.surface.alpha"), "64");
}

TEST_F(Compare, KeepsTheTruthWhereItIsTold) {
  const auto reference = [&] { return compare({"--volume", "none", "--cache", "kept"})["reference"]; };
  const Json traced = reference();
  EXPECT_EQ(reference(), traced) << "its time, too, is that of tracing it";
  EXPECT_EQ(std::distance(fs::directory_iterator(file("kept")), fs::directory_iterator()), 2);
  const Image image = render({"--volume", "reference", "--surface", "reference", "--cache", "kept"});
  EXPECT_EQ(image.channels.at("airlight.R"),
            quality::read_exr(file("out/reference.exr")).channels.at("airlight.R"));
}

TEST_F(Compare, JudgesByTheReference) {
  const Json results = compare({"--volume", "none,vsv,reference,reference-march", "--surface", "reference"});
  const Json &none = results["runs"][0], &vsv = results["runs"][1], &reference = results["runs"][2],
             &march = results["runs"][3];
  EXPECT_EQ(none["error"]["airlight"]["bias"], -1.0);
  EXPECT_EQ(reference["error"]["airlight"]["rmse"], 0.0);
  EXPECT_LT(vsv["error"]["airlight"]["rrmse"], 0.1);
  EXPECT_LT(march["error"]["airlight"]["rrmse"], 0.01);
  EXPECT_EQ(vsv["error"]["surface"]["wrong_pixels"], 0);
  // The truth that is kept is charged to the run that shows it.
  EXPECT_GE(reference["frame_ms"], results["reference"]["ms"]);
  EXPECT_FALSE(reference.contains("rays")) << "it casts none";
  EXPECT_EQ(march["rays"], 32 * 32 * 512);
  EXPECT_EQ(march["march_ratio"], 1.0);
  EXPECT_FALSE(none.contains("rays"));
}

TEST_F(Compare, JudgesSurfacesOnTheFramesOwnPoints) {
  const Json results = compare({"--volume", "none", "--surface", "psv,brute,shadow-map,none,reference"});
  const auto error = [&](std::size_t run, const char* what) {
    return results["runs"][run]["error"]["surface"][what].get<int>();
  };
  EXPECT_EQ(error(0, "wrong_pixels"), 0);
  EXPECT_EQ(error(1, "wrong_pixels"), 0);
  EXPECT_GT(error(3, "wrong_pixels"), 0);
  EXPECT_EQ(error(4, "wrong_pixels"), 0);
  for (std::size_t run = 0; run < 5; ++run) {
    EXPECT_EQ(error(run, "pixels"), error(4, "pixels"));
    EXPECT_EQ(error(run, "undecided_pixels"), error(4, "undecided_pixels"));
    EXPECT_LE(error(run, "wrong_pixels"), error(3, "wrong_pixels"));
  }
  // The verdicts are charged to the method that shows them.
  EXPECT_GT(results["runs"][4]["stages_ms"]["surface_query"].get<double>(), 0.0);
  EXPECT_EQ(quality::read_exr(file("out/reference.exr")).channels.at("surface.Y"),
            quality::read_exr(file("out/none+reference.exr")).channels.at("surface.Y"));
}

TEST_F(Compare, EachRunNamesTheCommandThatRepeatsIt) {
  const Json first = compare({"--volume", "vsv,vsv:integral=riemann", "--sigma-s", "0.3"})["runs"][1];
  const std::string command = first["command"];
  ASSERT_THAT(command, StartsWith("airlight compare cornell"));
  EXPECT_EQ(shell(quality::shell_quote(AIRLIGHT_BINARY) + command.substr(8)).exit_code, 0);
  const Json second =
      Json::parse(read_text(file("out/" + first["name"].get<std::string>() + "/results.json")))["runs"][0];
  EXPECT_EQ(second["settings"], first["settings"]);
  EXPECT_EQ(second["error"], first["error"]);
}

TEST_F(Compare, CommandsOfRunsHoldWhatTheirMethodsRead) {
  const Json results = compare({"--volume", "vsv,reference", "--surface", "none", "--max-error", "1"});
  const std::string vsv = results["runs"][0]["command"], reference = results["runs"][1]["command"];
  EXPECT_THAT(vsv, HasSubstr("--alpha 64"));
  EXPECT_EQ(reference.find("--alpha"), std::string::npos) << reference;
  EXPECT_EQ(shell(quality::shell_quote(AIRLIGHT_BINARY) + reference.substr(8)).exit_code, 0) << reference;
  const std::string truth = quality::read_exr(file("out/reference.exr")).metadata.at("airlight.command");
  EXPECT_EQ(shell(quality::shell_quote(AIRLIGHT_BINARY) + truth.substr(8)).exit_code, 0) << truth;
}

TEST_F(Compare, CommonOptionsAreDefaultsOfEachMethod) {
  const Json results = compare({"--volume", "vsv,vsv:alpha=32:theta=64", "--alpha", "128"});
  EXPECT_EQ(results["runs"][0]["settings"]["alpha"], 128);
  EXPECT_EQ(results["runs"][1]["settings"]["alpha"], 32);
  EXPECT_EQ(results["runs"][1]["settings"]["theta"], 64);
}

TEST_F(Compare, PrintsATableOrTheResults) {
  const Words words = {"compare", "cornell", "-o", "out", "--volume", "vsv", "--frames", "1"};
  const Result table = small(words);
  EXPECT_THAT(table.out, HasSubstr("rrmse %"));
  EXPECT_THAT(table.err, HasSubstr("xdg-open out/report.html"));
  EXPECT_EQ(table.err.find('\r'), std::string::npos) << "progress belongs on a terminal";

  Words with_json = words;
  with_json.insert(with_json.end(), {"--json", "-", "--quiet"});
  const Result json = small(with_json);
  EXPECT_EQ(json.out, read_text(file("out/results.json")));
  EXPECT_THAT(json.err, IsEmpty());

  with_json[with_json.size() - 2] = "copy.json";
  EXPECT_THAT(small(with_json).out, HasSubstr("rrmse %"));
  EXPECT_EQ(read_text(file("copy.json")), read_text(file("out/results.json")));
}

TEST_F(Compare, MissedAccuracyIsOneAfterEverythingIsWritten) {
  const Words words = {"compare",  "cornell",  "-o", "out",        "--volume",
                       "none,vsv", "--frames", "1",  "--max-error"};
  Words strict = words, lax = words;
  strict.push_back("1e-6");
  lax.push_back("0.5");  // `none` is off by more, but is not judged

  const Result missed = small(strict);
  EXPECT_EQ(missed.exit_code, 1);
  EXPECT_THAT(missed.err, HasSubstr("airlight: --max-error 1e-06: vsv"));
  EXPECT_THAT(missed.out, HasSubstr("rrmse %"));
  EXPECT_TRUE(fs::exists(file("out/report.html")));
  EXPECT_EQ(small(lax).exit_code, 0);
}

TEST_F(Compare, MoreUndecidedSurfacesThanAllowedAreOneAfterEverythingIsWritten) {
  const Words words = {"compare",   "cornell",  "-o",       "out", "--volume",       "none",
                       "--surface", "psv,none", "--frames", "1",   "--max-undecided"};
  Words strict = words, lax = words;
  strict.push_back("0");
  lax.push_back("1");
  const Result missed = small(strict);
  EXPECT_EQ(missed.exit_code, 1);
  EXPECT_THAT(missed.err, HasSubstr("airlight: --max-undecided 0: "));
  EXPECT_THAT(missed.err, HasSubstr("of the surface pixels of none × psv are undecided"));
  EXPECT_TRUE(fs::exists(file("out/report.html")));
  EXPECT_EQ(small(lax).exit_code, 0);
  for (const Json& run : Json::parse(read_text(file("out/results.json")))["runs"])
    EXPECT_EQ(run["command"].dump().find("--max-undecided"), std::string::npos);
}

TEST_F(Compare, DefaultsToTheWindowAndItsOwnFolder) {
  const Result result = small({"compare", "--frames", "1", "--size", "16x16"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json results = Json::parse(read_text(file("out/window/results.json")));
  ASSERT_EQ(results["runs"].size(), 3u);
  EXPECT_EQ(results["runs"][0]["volume"], "vsv");
  EXPECT_EQ(results["runs"][2]["volume"], "reference-march");
  EXPECT_EQ(results["runs"][0]["surface"], "shadow-map");
}

TEST_F(Compare, SceneWithoutGeometryIsSane) {
  const Result result = small({"compare", "empty", "-o", "out", "--volume", "vsv", "--frames", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json run = Json::parse(read_text(file("out/results.json")))["runs"][0];
  EXPECT_LT(run["error"]["airlight"]["rrmse"], 0.01);
  EXPECT_EQ(run["error"]["surface"]["pixels"], 0);
}

TEST_F(Compare, DarkReferenceGivesNoRelativeError) {
  const Json schema = Json::parse(read_text(AIRLIGHT_SCHEMA));
  // No light; none that is left by the fog; none of a magnitude that single precision holds.
  for (const Words& words : {Words{"--intensity", "0"}, {"--sigma-s", "1000"}, {"--intensity", "1e-35"}}) {
    const Json results = compare(words);
    EXPECT_EQ(results["reference"]["dark"], true) << words[1];
    const Json& error = results["runs"][0]["error"]["airlight"];
    EXPECT_EQ(error["dark"], true);
    EXPECT_TRUE(error["rrmse"].is_null() && error["bias"].is_null() && error["relmse"].is_null());
    EXPECT_LT(error["rmse"], 1e-30);
    EXPECT_THAT(tests::schema_violations(results, schema), IsEmpty());
    for (const std::string& text : {read_text(file("out/report.html")), read_text(file("stdout"))}) {
      EXPECT_THAT(text, HasSubstr("is not above the floor"));
      for (const char* word : {"inf ", "inf<", ">inf", " nan", ">nan"})
        EXPECT_EQ(text.find(word), std::string::npos) << word;
    }
  }
  const Json bright = compare({"--intensity", "1e-20", "--volume", "vsv"});
  EXPECT_EQ(bright["reference"]["dark"], false);
  EXPECT_EQ(bright["runs"][0]["error"]["airlight"]["dark"], false);

  // --max-error asks that a method be as dark.
  Words words = {"compare", "cornell", "-o", "out", "--volume", "vsv", "--frames", "1", "--max-error", "0"};
  words.insert(words.end(), {"--intensity", "0"});
  EXPECT_EQ(small(words).exit_code, 0);
}

/// A closed box about the origin, 2 m wide.
TEST_F(Compare, ShowsImagesInATevAsTheyAreRendered) {
  tests::TevListener tev;
  std::thread listening([&] { tev.listen_to_all(); });
  const Json results = compare({"--volume", "vsv", "--tev=" + tev.address});
  listening.join();
  ASSERT_EQ(tev.shown.size(), 2u);
  for (const std::string& name :
       {std::string("reference"), results.at("runs")[0].at("name").get<std::string>()}) {
    const Image image = quality::read_exr(file("out/" + name + ".exr"));
    const auto& shown = tev.shown.at(name).channels;
    ASSERT_EQ(shown.size(), image.channels.size());
    for (const auto& [channel, values] : image.channels) EXPECT_EQ(shown.at(channel), values) << channel;
  }
  EXPECT_THAT(results.at("runs")[0].at("command").get<std::string>(), Not(HasSubstr("tev")));
}

class Black : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    std::ofstream(file("box.obj"))
        << "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\n"
           "v -1 1 1\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 4 3 7 8\nf 1 4 8 5\nf 2 3 7 6\n";
  }
  std::string words_of(const char* eye, const char* light, const Words& more = {}) const {
    Words words = {"render", "box.obj", "-o", "x.exr", "--target", "0,0.1,0", "--intensity", "5"};
    words.insert(words.end(), {"--eye", eye, "--light-position", light});
    words.insert(words.end(), more.begin(), more.end());
    const Result result = small(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  }
};

TEST_F(Black, ImageIsSaidToBeAndWhy) {
  EXPECT_THAT(words_of("0,0,4", "0.1,0.2,0.3"),
              HasSubstr("the light is inside a closed part of the scene (12"));
  EXPECT_THAT(words_of("0,0,0.5", "3,0.2,0.3"),
              HasSubstr("the eye is inside a closed part of the scene (12"));
  EXPECT_THAT(words_of("0,0,4", "3,0.2,0.3", {"--sigma-a", "100", "--volume", "reference", "--albedo", "0"}),
              HasSubstr("lets through e^-"));
  EXPECT_THAT(words_of("0,0,80", "0,0.2,3", {"--sigma-a", "1"}), HasSubstr("lets through e^-"))
      << "a picture of 1e-35 is black";
  EXPECT_THAT(words_of("0,0,4", "3,0.2,0.3", {"--volume", "none", "--albedo", "0"}),
              HasSubstr("black: whatever is seen lies in shadow, or neither reflects nor scatters"));
  for (const char* light : {"3,0.2,0.3", "0,0.3,4.2"})
    EXPECT_EQ(words_of("0,0,4", light).find("black"), std::string::npos);
  EXPECT_EQ(words_of("0,0,0.5", "0.1,0.2,0.3").find("black"), std::string::npos) << "both are inside";
  EXPECT_EQ(words_of("0,0,4", "0.1,0.2,0.3").find("95th"), std::string::npos);
}

TEST_F(Black, ReferenceIsSaidToBeInTheResultsToo) {
  const Result result =
      small({"compare", "box.obj", "-o", "out", "--volume", "vsv", "--frames", "1", "--eye", "0,0,4",
             "--target", "0,0,0", "--light-position", "0,0.1,0", "--intensity", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("warning: the reference is black: the light is inside"));
  EXPECT_THAT(Json::parse(read_text(file("out/results.json")))["scene"]["warnings"].dump(),
              HasSubstr("the light is inside"));
}

// Sanitizers map more than any limit allows.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Driver, MemoryThatDoesNotSufficeIsNamedBeforeItIsWoken) {
  const std::string program = quality::shell_quote(AIRLIGHT_BINARY);
  for (const char* limit : {"200000", "500000"}) {
    const Result result = shell(fmt::format("ulimit -v {}; {} render cornell -o x.exr", limit, program));
    expect_one_line_error(result, 4);
    EXPECT_THAT(result.err, HasSubstr("(ulimit -v)"));
  }
  const Result large =
      shell(fmt::format("ulimit -v 1500000; {} render cornell -o x.exr --size 4096x4096", program));
  expect_one_line_error(large, 4);
  EXPECT_THAT(large.err, HasSubstr("--size: an image of 4096x4096 pixels takes about"));
}
#endif

/// A path through `cornell`: all moves, then the camera, then nothing.
class Paths : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    std::ofstream(file("path.toml")) << "frames = 5\nseconds = 4\n"
                                        "[[light]]\ntime = 0\nposition = [0, 1.8, 0]\n"
                                        "[[light]]\ntime = 1\nposition = [0.2, 1.7, 0]\n"
                                        "[[camera]]\ntime = 0\neye = [0, 1, 4.2]\ntarget = [0, 1, 0]\n"
                                        "[[camera]]\ntime = 2\neye = [0.5, 1, 4]\n";
  }
};

TEST_F(Paths, BecomeAVideoWhereFfmpegIs) {
  const Words words = {"render", "cornell", "--path", "path.toml", "-o", "50%d.exr", "--video", "walk.mp4"};
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {
    expect_one_line_error(small(words), 4);
    EXPECT_FALSE(fs::exists(file("50%d_0000.exr")));
    return;
  }
  const Result result = small(words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string video = read_text(file("walk.mp4"));
  EXPECT_EQ(video.substr(4, 4), "ftyp");
  EXPECT_THAT(video, HasSubstr("moov"));
  expect_one_line_error(small({"render", "cornell", "-o", "x.exr", "--video", "x.mp4"}), 2);
}

TEST_F(Paths, RendersNumberedImagesOfOneExposure) {
  const Result result = small({"render", "cornell", "--path", "path.toml", "-o", "out.exr"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<Image> images;
  for (const char* name : {"out_0000", "out_0001", "out_0002", "out_0003", "out_0004"}) {
    EXPECT_TRUE(fs::exists(file(std::string(name) + ".png"))) << name;
    images.push_back(quality::read_exr(file(std::string(name) + ".exr")));
  }
  EXPECT_FALSE(fs::exists(file("out.exr")));
  EXPECT_FALSE(fs::exists(file("out_0005.exr")));
  for (const Image& image : images)
    EXPECT_EQ(image.metadata.at("airlight.exposure"), images[0].metadata.at("airlight.exposure"));
  EXPECT_EQ(images[0].metadata.at("airlight.eye"), "0,1,4.2");
  EXPECT_EQ(images[4].metadata.at("airlight.eye"), "0.5,1,4");
  EXPECT_NE(images[0].channels.at("airlight.G"), images[1].channels.at("airlight.G"));
  EXPECT_EQ(images[2].channels, images[4].channels) << "nothing moves";

  // What was kept shows in no image.
  const Image alone =
      render({"--eye", "0.5,1,4", "--target", "0,1,0", "--light-position", "0.2,1.7,0", "--intensity",
              images[4].metadata.at("airlight.intensity"), "--fov", images[4].metadata.at("airlight.fov")});
  EXPECT_EQ(images[4].channels, alone.channels);
}

TEST_F(Paths, AreComparedFrameByFrame) {
  const Json results = compare(
      {"--path", "path.toml", "--volume", "none,vsv,vsv:populate=conservative,reference-march:steps=64"});
  EXPECT_THAT(tests::schema_violations(results, Json::parse(read_text(AIRLIGHT_SCHEMA))), IsEmpty());
  std::vector<std::string> moves;
  for (const Json& frame : results["path"]["frames"]) moves.push_back(frame["moves"]);
  EXPECT_THAT(moves, testing::ElementsAre("all", "all", "camera", "nothing", "nothing"));
  EXPECT_EQ(results["path"]["frames"][3]["time"], 3.0);
  for (const Json& run : results["runs"]) {
    const Json& path = run["path"];
    ASSERT_EQ(path["frames"].size(), 5u);
    std::vector<Json> redrawn;
    double mean = 0.0, worst = 0.0;
    for (const Json& frame : path["frames"]) {
      redrawn.push_back(frame["redrawn"]);
      mean += frame["frame_ms"].get<double>() / 5.0;
      if (frame["rrmse"].is_number()) worst = std::max(worst, frame["rrmse"].get<double>());
    }
    EXPECT_NEAR(path["frame_ms"]["mean"].get<double>(), mean, 1e-6 * mean);
    EXPECT_EQ(path["rrmse"]["worst"], worst);
    // Of frames in which nothing moves nothing flickers, and of the first one there is none before.
    EXPECT_TRUE(path["frames"][0]["flicker"].is_null());
    EXPECT_GT(path["frames"][1]["flicker"], 0.0) << run["volume"];
    EXPECT_EQ(path["frames"][4]["flicker"], 0.0) << run["volume"];
    EXPECT_GE(path["flicker"]["worst"], path["frames"][1]["flicker"]);
    EXPECT_EQ(run["error"]["airlight"]["rrmse"], worst);
    const bool has_volume = run["volume"].get<std::string>().starts_with("vsv");
    const Json map = {"shadow_map"}, both = {"shadow_map", "volume"}, volume = {"volume"},
               nothing = Json::array();
    EXPECT_EQ(redrawn[0], has_volume ? both : map) << run["volume"];
    EXPECT_EQ(redrawn[1], has_volume ? both : map) << run["volume"];
    EXPECT_EQ(redrawn[2], has_volume ? volume : nothing) << run["volume"];
    EXPECT_EQ(redrawn[3], nothing) << run["volume"];
    const std::string name = run["name"];
    for (const std::string& image :
         {name + "_0004.png", name + "_error_0004.png", name + "_surface_0004.png"})
      EXPECT_TRUE(fs::exists(file("out/" + image))) << image;
  }
  EXPECT_TRUE(fs::exists(file("out/reference_0004.png")));
  EXPECT_THAT(read_text(file("out/report.html")), HasSubstr("Along the path"));
}

TEST_F(Paths, HaveTheSurfacesOfEachFrameJudged) {
  const Json results =
      compare({"--path", "path.toml", "--volume", "none", "--surface", "psv,reference,none"});
  for (std::size_t i = 0; i < 5; ++i) {
    const auto frame = [&](std::size_t run) { return results["runs"][run]["path"]["frames"][i]; };
    EXPECT_EQ(frame(0)["wrong_pixels"], 0) << i;
    EXPECT_EQ(frame(1)["wrong_pixels"], 0) << i;
    EXPECT_GT(frame(2)["wrong_pixels"], 0) << i;
    EXPECT_EQ(frame(2)["undecided_pixels"], frame(1)["undecided_pixels"]) << i;
    EXPECT_GT(frame(2)["pixels"], 0) << i;
  }
}

TEST_F(Paths, OrdinaryFramesDrawAllOfTheirOwn) {
  const Json results = compare({"--volume", "vsv"});
  EXPECT_FALSE(results.contains("path"));
  for (const char* stage : {"shadow_map", "populate", "scan"})
    EXPECT_TRUE(results["runs"][0]["stages_ms"].contains(stage))
        << "a frame of a resting view costs " << stage;
}

TEST_F(Paths, FitWhatIsAutomaticToAllFrames) {
  std::ofstream(file("zoom.toml")) << "frames = 3\nseconds = 2\n[[camera]]\ntime = 0\nfov = 60\n[[camera]]\n"
                                      "time = 1\nfov = 20\n[[camera]]\ntime = 2\nfov = 60\n";
  // No grid of fewer cells has so small an error.
  const auto alpha = [&](const Words& words, const char* image) {
    Words all = {"render", "cornell", "-o", "image.exr", "--alpha", "auto", "--max-error", "1e-9"};
    all.insert(all.end(), words.begin(), words.end());
    const Result result = small(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::stoi(quality::read_exr(file(image)).metadata.at("airlight.alpha"));
  };
  EXPECT_EQ(alpha({"--path", "zoom.toml"}, "image_0000.exr"),
            std::max(alpha({"--fov", "60"}, "image.exr"), alpha({"--fov", "20"}, "image.exr")));
}

/// A floor and, in its shadow's way, the triangle of a node that a path moves.
TEST_F(Paths, MoveNodesOfAModel) {
  Json document = tests::triangle();
  const std::vector<float> floor = {-3, -1, -3, -3, -1, 3, 3, -1, 3, 3, -1, -3};
  Json primitive = tests::primitive(document);
  primitive["attributes"]["POSITION"] = tests::add_accessor(document, floor, tests::k_float, "VEC3");
  primitive["indices"] =
      tests::add_accessor(document, std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, tests::k_u16, "SCALAR");
  document["meshes"].push_back({{"primitives", {primitive}}});
  document["nodes"][0]["name"] = "sail";
  document["nodes"].push_back({{"mesh", 1}});
  document["scenes"][0]["nodes"].push_back(1);
  std::ofstream(file("model.gltf")) << document.dump();
  std::ofstream(file("nodes.toml"))
      << "frames = 3\nseconds = 2\n[[node]]\nname = 'sail'\ntime = 0\n"
         "[[node]]\nname = 'sail'\ntime = 1\ntranslation = [0, 0, 0]\nrotation = [0, 0, 0, 1]\n"
         "[[node]]\nname = 'sail'\ntime = 2\ntranslation = [-1, 0, 0.5]\n"
         "rotation = [0, 0.6, 0, 0.8]\n";
  document["nodes"][0]["translation"] = {-1, 0, 0.5};
  document["nodes"][0]["rotation"] = {0, 0.6, 0, 0.8};
  std::ofstream(file("moved.gltf")) << document.dump();
  const auto channels = [&](Words words, const char* volume, const char* surface, const char* image) {
    words.insert(words.begin(), "render");
    words.insert(words.end(), {"-o", "out.exr", "--light-position", "0.3,3,0.2", "--intensity", "9", "--eye",
                               "0,2,6", "--target", "0,0,0", "--volume", volume, "--surface", surface});
    const Result result = small(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return quality::read_exr(file(image)).channels;
  };
  const std::map<const char*, const char*> methods = {
      {"vsv", "metric-tree"}, {"march", "shadow-map"}, {"reference", "reference"}};
  for (const auto& [volume, surface] : methods) {
    const auto rest = channels({"model.gltf"}, volume, surface, "out.exr"),
               there = channels({"moved.gltf"}, volume, surface, "out.exr");
    EXPECT_NE(rest, there);
    const Words words = {"model.gltf", "--path", "nodes.toml", "--cache", "cache"};
    for (int run = 0; run < 2; ++run) {
      EXPECT_EQ(channels(words, volume, surface, "out_0002.exr"), there) << volume << ", run " << run;
      EXPECT_EQ(quality::read_exr(file("out_0001.exr")).channels, rest);
      EXPECT_EQ(quality::read_exr(file("out_0000.exr")).channels, rest);
    }
  }

  Words words = {
      "compare",   "model.gltf",  "--path",    "nodes.toml",      "-o",      "out",      "--light-position",
      "0.3,3,0.2", "--intensity", "9",         "--eye",           "0,2,6",   "--target", "0,0,0",
      "--volume",  "vsv",         "--surface", "metric-tree,psv", "--cache", "cache"};
  const Result result = small(words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json results = Json::parse(read_text(file("out/results.json")));
  EXPECT_THAT(tests::schema_violations(results, Json::parse(read_text(AIRLIGHT_SCHEMA))), IsEmpty());
  EXPECT_EQ(results["path"]["frames"][1]["moves"], "nothing");
  EXPECT_EQ(results["path"]["frames"][2]["moves"], "objects");
  for (const Json& run : results["runs"])
    for (const Json& frame : run["path"]["frames"]) EXPECT_EQ(frame["wrong_pixels"], 0) << run["surface"];

  const Result window = airlight(
      {"view", "model.gltf", "--path", "nodes.toml", "--light-position", "0.3,3,0.2", "--intensity", "9"});
  expect_one_line_error(window, 2);
  EXPECT_THAT(window.err, HasSubstr("--path: it moves nodes"));
  std::ofstream(file("wrong.toml")) << "frames = 3\nseconds = 2\n[[node]]\nname = 'keel'\ntime = 0\n";
  const Result wrong = airlight({"render", "model.gltf", "--path", "wrong.toml", "-o", "x.exr",
                                 "--light-position", "0,3,0", "--intensity", "9"});
  expect_one_line_error(wrong, 3);
  EXPECT_THAT(wrong.err, HasSubstr("the scene has no node 'keel'; it has 'sail' (0), 'node1' (1)"));
}

TEST_F(Paths, ThatCannotBeAreErrors) {
  std::ofstream(file("bad.toml")) << "frames = 5\nseconds = 4\n[[camera]]\ntime = 0\nroll = 3\n";
  expect_one_line_error(airlight({"render", "cornell", "--path", "bad.toml", "-o", "x.exr"}), 3);
  std::ofstream(file("into.toml"))
      << "frames = 3\nseconds = 4\n[[light]]\ntime = 0\nposition = [0, 1, 4.2]\n";
  const Result result = airlight({"compare", "cornell", "--path", "into.toml"});
  expect_one_line_error(result, 3);
  EXPECT_THAT(result.err, HasSubstr("into.toml, frame 0 (0 s)"));
  expect_one_line_error(airlight({"compare", "cornell", "--path", "path.toml", "--debug"}), 2);
  expect_one_line_error(airlight({"render", "cornell", "--path", "none.toml", "-o", "x.exr"}), 3);
}

class Sweep : public CommandLine {
 protected:
  Result sweep(const Words& arguments) const {
    Words all = {"sweep", "cornell", "--size", "24x24", "--theta", "64", "--frames", "2"};
    for (const char* name : {"--size", "--theta", "--frames"}) {
      if (std::find(arguments.begin(), arguments.end(), name) == arguments.end()) continue;
      const auto usual = std::find(all.begin(), all.end(), name);
      all.erase(usual, usual + 2);
    }
    all.insert(all.end(), arguments.begin(), arguments.end());
    return airlight(all);
  }

  std::vector<Json> lines_of(const std::string& name) const {
    std::vector<Json> lines;
    if (!fs::exists(file(name))) return {};
    for (const std::string& line : quality::whole_lines(file(name))) lines.push_back(Json::parse(line));
    return lines;
  }

  /// What of runs does not depend on when and where they ran, by their keys, each of which is there once.
  std::map<std::string, Json> errors_of(const Words& files) const {
    std::map<std::string, Json> errors;
    for (const std::string& name : files)
      for (const Json& line : lines_of(name)) {
        const Json told = {line["error"], line["bytes"], line["settings"], line["views"]["rrmse"]};
        EXPECT_TRUE(errors.emplace(line["key"], told).second) << line["key"] << " is there twice";
      }
    return errors;
  }
};

const Words k_grids = {"--volume", "vsv:alpha={16,32}:phi={128,256}", "--shadow-map", "{32,64}"};

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(Sweep, WritesALineForEachOfTheProduct) {
  const Result result = sweep(k_grids + Words{"--surface", "shadow-map,none", "--frames", "6", "-o", "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("16 measured, 0 were there"));
  const Json schema = Json::parse(read_text(AIRLIGHT_SCHEMA));
  const Json& of_run = schema.at("properties").at("runs").at("items");
  std::set<std::tuple<std::string, std::string, int>> seen;
  for (const Json& line : lines_of("out/runs.jsonl")) {
    EXPECT_THAT(tests::schema_violations(line, of_run, "", &schema), IsEmpty());
    for (const char* name :
         {"key", "airlight", "scene", "subject", "size", "shadow_map", "device", "timing", "views"})
      EXPECT_TRUE(line.contains(name)) << name;
    seen.emplace(line["volume"].get<std::string>(), line["surface"].get<std::string>(),
                 line["shadow_map"].get<int>());
    EXPECT_EQ(line["settings"]["theta"], 64);
    const Json& timing = line["timing"];
    EXPECT_EQ(timing["baseline"]["volume"], "vsv");
    EXPECT_EQ(timing["baseline"]["shadow_map"], 32);
    EXPECT_EQ(timing["rounds"], 6);
    EXPECT_GT(timing["ratio"]["median"], 0.0);
    EXPECT_LE(timing["ratio"]["low"], timing["ratio"]["median"]);
    EXPECT_GE(timing["ratio"]["high"], timing["ratio"]["median"]);
    EXPECT_FALSE(timing.contains("odd_ratio"));
    EXPECT_GT(line["cpu_ms"], 0.0);
    EXPECT_EQ(line["views"]["same_surface_rrmse"][0], line["error"]["airlight_same_surface"]["rrmse"]);
  }
  EXPECT_EQ(seen.size(), 16u);
}

TEST_F(Sweep, FindsWhatCompareFinds) {
  ASSERT_EQ(sweep({"--volume", "vsv:phi={128,256}", "--shadow-map", "64", "-o", "out"}).exit_code, 0);
  for (const Json& line : lines_of("out/runs.jsonl")) {
    const std::string words = line["command"];
    ASSERT_THAT(words, StartsWith("airlight compare cornell "));
    const std::string command =
        fmt::format("{} {}", quality::shell_quote(AIRLIGHT_BINARY), words.substr(words.find(' ')));
    ASSERT_EQ(shell(command).exit_code, 0) << command;
    const Json results =
        Json::parse(read_text(file("out/" + line["key"].get<std::string>() + "/results.json")));
    EXPECT_EQ(results["runs"][0]["error"], line["error"]);
    EXPECT_EQ(results["runs"][0]["bytes"], line["bytes"]);
  }
}

TEST_F(Sweep, KeysAreOfWhatIsMeasuredAlone) {
  // A setting that is written otherwise is the same one; what no method reads makes none.
  ASSERT_EQ(sweep({"--volume", "vsv:theta=64,vsv:phi=512,vsv,reference", "--surface", "none", "--shadow-map",
                   "{32,64}", "-o", "out"})
                .exit_code,
            0);
  const auto first = lines_of("out/runs.jsonl");
  EXPECT_EQ(first.size(), 3u);
  for (const Json& line : first) EXPECT_EQ(line["shadow_map"].is_null(), line["volume"] == "reference");

  // Another view is another subject, and has other keys.
  ASSERT_EQ(sweep({"--volume", "vsv", "--surface", "none", "--shadow-map", "32", "--fov", "20", "-o", "out"})
                .exit_code,
            0);
  const auto both = lines_of("out/runs.jsonl");
  ASSERT_EQ(both.size(), 4u);
  EXPECT_NE(both[3]["subject"], both[0]["subject"]);

  // Whoever changes what a key is of loses what was measured. A new option of a method does so for its runs
  // alone.
  ASSERT_EQ(airlight({"sweep", "cornell", "--size", "24x24", "--volume", "none", "--surface", "none",
                      "--baseline", "none", "--frames", "1", "-o", "none"})
                .exit_code,
            0);
  EXPECT_EQ(lines_of("none/runs.jsonl").at(0)["key"], "fc6bfee2319f68f31d8e107b2ca94d0a");
}

TEST_F(Sweep, MeasuresNothingTwice) {
  ASSERT_EQ(sweep({"--volume", "vsv:phi={128,256}", "--shadow-map", "32", "-o", "out"}).exit_code, 0);
  const std::string before = read_text(file("out/runs.jsonl"));
  const Result again = sweep({"--volume", "vsv:phi={256,384,128}", "--shadow-map", "32", "-o", "out"});
  EXPECT_THAT(again.err, HasSubstr("1 measured, 2 were there"));
  const std::string after = read_text(file("out/runs.jsonl"));
  EXPECT_THAT(after, StartsWith(before));
  EXPECT_EQ(errors_of({"out/runs.jsonl"}).size(), 3u);

  // A line that a kill has torn is measured anew, one that is no run is an error.
  std::ofstream(file("out/runs.jsonl"), std::ios::binary) << after.substr(0, after.size() - 100);
  const Result torn = sweep({"--volume", "vsv:phi={256,384,128}", "--shadow-map", "32", "-o", "out"});
  EXPECT_THAT(torn.err, HasSubstr("1 measured, 2 were there"));
  EXPECT_EQ(errors_of({"out/runs.jsonl"}).size(), 3u);
  std::ofstream(file("out/runs.jsonl"), std::ios::app) << "{}\n";
  const Result broken = sweep({"--volume", "vsv", "--shadow-map", "32", "-o", "out"});
  expect_one_line_error(broken, 3);
  EXPECT_THAT(broken.err, HasSubstr("runs.jsonl, line 4: it is no run"));
}

TEST_F(Sweep, KilledAndResumedEndsWithTheSame) {
  const Words words = {"--volume",     "vsv:alpha={8,16,32}:phi={128,256},vsv:phi={128,256}:integral=riemann",
                       "--surface",    "{shadow-map,none}",
                       "--shadow-map", "32"};
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(sweep(words + Words{"-o", "whole"}).exit_code, 0);
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  const auto whole = errors_of({"whole/runs.jsonl"});
  ASSERT_EQ(whole.size(), 16u);

  // Killed ten times, at random.
  std::string command = quality::shell_quote(AIRLIGHT_BINARY) +
                        " sweep cornell --size 24x24 --theta 64 --frames 2 --quiet -o out";
  for (const std::string& word : words) command += fmt::format(" {}", quality::shell_quote(word));
  std::size_t lines = 0;
  std::mt19937 random(1);
  for (int kill = 0; kill < 10; ++kill) {
    const double part = std::uniform_real_distribution(0.03, 0.6)(random);
    shell(fmt::format("timeout -s KILL {:.3f} {}; true", part * duration.count(), command));
    const std::size_t kept = errors_of({"out/runs.jsonl"}).size();
    EXPECT_GE(kept, lines);
    lines = kept;
  }
  ASSERT_EQ(sweep(words + Words{"-o", "out"}).exit_code, 0);
  EXPECT_EQ(errors_of({"out/runs.jsonl"}), whole);
}

TEST_F(Sweep, ShardsJoinedAreTheWhole) {
  ASSERT_EQ(sweep(k_grids + Words{"-o", "whole"}).exit_code, 0);
  for (const char* shard : {"1/3", "2/3", "3/3"})
    ASSERT_EQ(sweep(k_grids + Words{"--shard", shard, "-o", "out"}).exit_code, 0);
  const Words shards = {"out/runs-1-of-3.jsonl", "out/runs-2-of-3.jsonl", "out/runs-3-of-3.jsonl"};
  for (const std::string& shard : shards) EXPECT_FALSE(lines_of(shard).empty()) << shard;
  EXPECT_EQ(errors_of(shards), errors_of({"whole/runs.jsonl"}));
  EXPECT_THAT(sweep(k_grids + Words{"-o", "out"}).err, HasSubstr("0 measured, 8 were there"));
}

TEST_F(Sweep, OfTheSameShardGoesOnOnlyOnce) {
  fs::create_directories(file("out"));
  const std::string command = quality::shell_quote(AIRLIGHT_BINARY);
  const Result locked = shell("flock out/runs.jsonl " + command + " sweep cornell --volume vsv -o out");
  expect_one_line_error(locked, 3);
  EXPECT_THAT(locked.err, HasSubstr("another sweep writes it"));
}

TEST_F(Sweep, OfAllTakesUpToFortySettingsOfEachMethod) {
  std::size_t expected = 0;
  for (const quality::VolumeMethod& method : quality::volume_methods())
    if (method.traits.is_judged()) expected += quality::settings_worth_sweeping(method, {}, 40).size();
  const Result result = airlight({"sweep", "cornell", "--size", "8x8", "--shadow-map", "32", "--frames", "1",
                                  "--all", "--shard", "1/20", "-o", "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto shard = lines_of("out/runs-1-of-20.jsonl");
  EXPECT_THAT(shard.size(), testing::AllOf(testing::Gt(0u), testing::Lt(expected)));
  for (const Json& line : shard) EXPECT_EQ(line["surface"], "shadow-map");
}

TEST_F(Sweep, ReadsAFileOfAxes) {
  std::ofstream(file("axes.toml")) << "shadow-map = [32, 64]\n[[volume]]\nmethod = 'vsv'\nphi = [128, 256]\n"
                                      "integral = 'riemann'\n[[surface]]\nmethod = 'none'\n";
  ASSERT_EQ(sweep({"--axes", "axes.toml", "-o", "out"}).exit_code, 0);
  ASSERT_EQ(sweep({"--volume", "vsv:phi={128,256}:integral=riemann", "--surface", "none", "--shadow-map",
                   "{32,64}", "-o", "same"})
                .exit_code,
            0);
  EXPECT_EQ(errors_of({"out/runs.jsonl"}), errors_of({"same/runs.jsonl"}));
  const Result twice = sweep({"--axes", "axes.toml", "--surface", "none", "-o", "out"});
  expect_one_line_error(twice, 2);
  EXPECT_THAT(twice.err, HasSubstr("--surface: the file of axes has it too"));
}

TEST_F(Sweep, ShowsItsFront) {
  ASSERT_EQ(
      sweep({"--volume", "vsv:phi={128,256},reference", "--shadow-map", "32", "--frames", "6", "-o", "a"})
          .exit_code,
      0);
  const Result tables = airlight({"front", "a"});
  EXPECT_EQ(tables.exit_code, 0) << tables.err;
  EXPECT_THAT(tables.err, IsEmpty());
  EXPECT_THAT(tables.out,
              testing::AllOf(HasSubstr("cornell, 24x24 pixels, 1 view, 3 runs"), HasSubstr("lead")));
  const Result json = airlight({"front", "a", "a/runs.jsonl", "--json", "-"});
  const Json fronts = Json::parse(json.out);
  ASSERT_EQ(fronts["fronts"].size(), 1u);
  EXPECT_EQ(fronts["fronts"][0]["runs"], 3u);
  EXPECT_EQ(airlight({"front", "a", "--json", "front.json"}).out, tables.out);
  EXPECT_EQ(Json::parse(read_text(file("front.json"))), fronts);
  expect_one_line_error(airlight({"front", "nosuch"}), 3);
  expect_one_line_error(airlight({"front"}), 2);
  expect_one_line_error(airlight({"front", "a", "--volume", "vsv"}), 2);
}

TEST_F(Sweep, IsJoinedWithComparisonsInOneReport) {
  const Words view = {"--size", "32x32"};
  ASSERT_EQ(sweep(k_grids + view + Words{"--shard", "1/2", "-o", "swept"}).exit_code, 0);
  ASSERT_EQ(sweep(k_grids + view + Words{"--shard", "2/2", "-o", "swept"}).exit_code, 0);
  ASSERT_EQ(airlight({"compare", "cornell", "--size", "32x32", "--frames", "1", "--shadow-map", "64",
                      "--volume", "vsv:alpha=16:theta=64:phi=128,march", "-o", "compared"})
                .exit_code,
            0);
  const Result joined = airlight({"report", "swept", "compared", "swept", "-o", "new/page.html"});
  ASSERT_EQ(joined.exit_code, 0) << joined.err;
  EXPECT_THAT(joined.out, IsEmpty());
  EXPECT_THAT(joined.err, HasSubstr("xdg-open new/page.html"));
  const std::string page = read_text(file("new/page.html"));
  const std::string begin = "id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  const Json data = Json::parse(page.substr(from, page.find("</script>", from) - from));
  ASSERT_EQ(data["runs"].size(), 9u) << "one of the comparison's is one of the sweep's";
  EXPECT_EQ(data["images"]["runs"].size(), 2u) << "which has its images";
  EXPECT_EQ(data["images"]["size"], (Json{32, 32}));

  ASSERT_EQ(sweep(k_grids + Words{"-o", "smaller"}).exit_code, 0);
  const Result other = airlight({"report", "compared", "smaller", "-o", "other.html"});
  expect_one_line_error(other, 3);
  EXPECT_THAT(other.err, HasSubstr("smaller/runs.jsonl, line 1: it shows another scene or view"));
  const Result missing = airlight({"report", "nosuch", "-o", "other.html"});
  expect_one_line_error(missing, 3);
  EXPECT_THAT(missing.err, HasSubstr("nosuch"));
  EXPECT_FALSE(fs::exists(file("other.html")));
  EXPECT_THAT(airlight({"report", "swept", "-o", "alone.html", "--quiet"}).err, IsEmpty());
  EXPECT_THAT(read_text(file("alone.html")), HasSubstr("A sweep keeps no images"));
}

TEST_F(Paths, AreSweptViewByView) {
  const Result result = small({"sweep", "cornell", "--path", "path.toml", "--volume", "vsv:theta={32,64}",
                               "--frames", "2", "-o", "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json results = compare({"--path", "path.toml", "--volume", "vsv:theta=32,vsv:theta=64"});
  std::ifstream stream(file("out/runs.jsonl"));
  std::size_t lines = 0;
  for (std::string text; std::getline(stream, text); ++lines) {
    const Json line = Json::parse(text);
    const Json& run = results["runs"][line["volume"] == "vsv:theta=32" ? 0 : 1];
    EXPECT_EQ(line["error"], run["error"]);
    ASSERT_EQ(line["views"]["rrmse"].size(), 5u);
    EXPECT_EQ(line["views"]["frame_ms"].size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(line["views"]["rrmse"][i], run["path"]["frames"][i]["rrmse"]);
      EXPECT_EQ(line["views"]["same_surface_rrmse"][i], run["path"]["frames"][i]["same_surface_rrmse"]);
      EXPECT_EQ(line["views"]["flicker"][i], run["path"]["frames"][i]["flicker"]);
      EXPECT_EQ(line["views"]["flicker"][i].is_null(), i == 0);
    }
    EXPECT_GT(line["timing"]["odd_ratio"]["median"], 0.0);
    EXPECT_GT(line["timing"]["even_ratio"]["median"], 0.0);
  }
  EXPECT_EQ(lines, 2u);
}

}  // namespace
}  // namespace airlight
