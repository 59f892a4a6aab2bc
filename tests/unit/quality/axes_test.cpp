#include "quality/axes.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "scene/error.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Braces, GiveTheProductTheLastChangingFastest) {
  EXPECT_THAT(expand_braces("x", "a"), ElementsAre("a"));
  EXPECT_THAT(expand_braces("x", "a,b:c=1"), ElementsAre("a", "b:c=1"));
  EXPECT_THAT(expand_braces("x", "a{1,2}b{3,4},c"), ElementsAre("a1b3", "a1b4", "a2b3", "a2b4", "c"));
  EXPECT_THAT(expand_braces("x", "{512,1024}"), ElementsAre("512", "1024"));
  EXPECT_THAT(expand_braces("x", "{1}"), ElementsAre("1"));
  EXPECT_THAT(expand_braces("x", ""), ElementsAre(""));
}

TEST(Braces, ThatAreNoneAreErrorsOfTheOption) {
  const auto complaint = [](std::string_view list) -> std::string {
    try {
      expand_braces("--volume", list);
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code, ExitCode::usage);
      return error.what();
    }
    return "none";
  };
  for (const auto& [list, problem] : std::map<std::string_view, std::string>{
           {"a{1", "a brace opens that none closes"},
           {"a{1,b", "a brace opens that none closes"},
           {"a1}", "a brace closes that none opens"},
           {"}{", "a brace closes that none opens"},
           {"a{1,{2,3}}", "braces within braces"},
           {"a{}", "a value in braces is empty"},
           {"a{1,,2}", "a value in braces is empty"},
           {"{1,2,3,4,5,6,7,8}{1,2,3,4,5,6,7,8}{1,2,3,4,5,6,7,8}{1,2,3,4,5,6,7,8}{1,2,3,4,5,6,7,8}{1,2,3,4}",
            "more than 100000"}}) {
    EXPECT_THAT(complaint(list), testing::AllOf(testing::StartsWith("--volume: "), HasSubstr(problem)));
  }
}

class AxesFile : public testing::Test {
 protected:
  ~AxesFile() override { std::filesystem::remove(file_); }
  Axes read(const std::string& text) const {
    std::ofstream(file_) << text;
    return read_axes(file_);
  }
  std::string complaint(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code, ExitCode::bad_file);
      return error.what();
    }
    return "none";
  }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-axes-{}.toml", getpid());
};

TEST_F(AxesFile, IsTheListsOfTheOptions) {
  const Axes axes = read(
      "shadow-map = [512, 1024]\n"
      "[[volume]]\nmethod = 'vsv'\nalpha = [64, 'auto']\nphi = 128\n"
      "[[volume]]\nmethod = 'reference'\n");
  EXPECT_EQ(axes.shadow_maps, "{512,1024}");
  EXPECT_EQ(axes.volumes, "vsv:alpha={64,auto}:phi=128,reference");
  EXPECT_FALSE(axes.surfaces);
  EXPECT_EQ(read("shadow-map = 512").shadow_maps, "512");
}

TEST_F(AxesFile, ThatIsNoneIsAnErrorOfItsLine) {
  EXPECT_THAT(complaint("\nspeed = 1"), HasSubstr("line 2, speed: there is no such axis"));
  EXPECT_THAT(complaint("shadow-map = []"), HasSubstr("line 1, shadow-map: it has no values"));
  EXPECT_THAT(complaint("shadow-map = [1.5]"), HasSubstr("line 1, shadow-map: it must be whole numbers"));
  EXPECT_THAT(complaint("volume = 'vsv'"), HasSubstr("write [[volume]]"));
  EXPECT_THAT(complaint("[[volume]]\nalpha = 3"), HasSubstr("line 1, volume: its method is missing"));
  EXPECT_THAT(complaint("[[volume]]\nmethod = 'vsv'\nalpha = '1,2'"), HasSubstr("'1,2' is no word"));
  EXPECT_THAT(complaint("[[volume]]\nmethod = 'vsv'\nalpha = [true]"), HasSubstr("line 3, volume.alpha"));
  EXPECT_THAT(complaint("[[volume"), HasSubstr("line 1"));
}

TEST(SettingsWorthSweeping, AreValidDifferentAndNoMoreThanAsked) {
  for (const VolumeMethod& method : volume_methods()) {
    std::size_t values = 0, product = 1;
    for (const frame::Option& option : method.options) {
      if (option.text.sweep.empty()) continue;
      product *= option.text.sweep.size();
      values += option.text.sweep.size();
      // Each of them is one that the option takes.
      for (const std::string_view value : option.text.sweep)
        EXPECT_NO_THROW(parse_volumes(fmt::format("{}:{}={}", method.name, option.text.name, value)));
    }
    for (const std::size_t most : {1u, 5u, 40u}) {
      const std::vector<VolumeChoice> settings = settings_worth_sweeping(method, {}, most);
      std::set<std::map<std::string, frame::OptionValue>> seen;
      for (const VolumeChoice& setting : settings) seen.insert(setting.values());
      EXPECT_EQ(seen.size(), settings.size()) << method.name;
      EXPECT_EQ(settings.size(), std::min(most, product)) << method.name;
      if (product <= most || most <= values) continue;
      EXPECT_EQ(settings[0].spec, method.name);
      for (const frame::Option& option : method.options)
        for (const std::string_view value : option.text.sweep)
          EXPECT_TRUE(std::any_of(settings.begin(), settings.end(),
                                  [&](const VolumeChoice& setting) {
                                    return frame::text_of(
                                               setting.values().at(std::string(option.text.name))) == value;
                                  }))
              << method.name << " " << option.text.name << " " << value;
    }
  }
}

}  // namespace
}  // namespace airlight::quality
