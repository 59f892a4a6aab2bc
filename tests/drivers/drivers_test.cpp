// The same frames on two OpenGL drivers: this machine's default, and zink on lavapipe, which hands the
// shaders through another compiler front end, keeps state and resources in its own way and rounds otherwise.
// What one of them forgives, as an undefined value or a wrong layout, shows as a difference. A missing
// barrier does not: zink derives its barriers from what the passes touch, and llvmpipe runs one pass after
// the other.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "quality/compare.h"
#include "quality/image_io.h"
#include "support/paths.h"

namespace airlight {
namespace {

namespace fs = std::filesystem;
using quality::Image;
using testing::HasSubstr;
using testing::Not;

// Both compute the same functions with other roundings. Differences are in parts of the value, or of the
// channel's mean where that is larger.
//
// Roundings alone, carried through the table and the sum over a ray, were seen to reach 1e-5. A pixel that is
// farther apart than this has other bits:
constexpr double k_rounding = 5e-5;
// A rounding flips the bit of a voxel or of a shadow map's texel that lies on a shadow's boundary, or moves a
// silhouette past a pixel's centre. Hardly any is that near (none was seen); a mistake is not so
// rare.
constexpr double k_most_pixels = 0.005;
// Such a bit is one of some hundred of a pixel's integral, and near the light a few times the average one.
constexpr double k_largest_airlight = 0.05;

/// A folder for two runs of the program, `default` and `zink`.
class Drivers : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("airlight-drivers-{}", getpid());
    fs::create_directories(folder_);
    if (run("zink", "info") == 77) GTEST_SKIP() << text("zink");
    ASSERT_EQ(run("default", "info"), 0) << text("default");
    ASSERT_THAT(text("default"), Not(HasSubstr("zink")));
    ASSERT_THAT(text("zink"), HasSubstr("zink"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// @returns the exit code.
  int run(const std::string& driver, const std::string& arguments) const {
    const std::string command =
        fmt::format("cd {} && {} {} {} >{}.log 2>&1 </dev/null", quality::shell_quote(folder_.string()),
                    driver == "zink" ? quality::shell_quote(AIRLIGHT_ON_ZINK) : "",
                    quality::shell_quote(AIRLIGHT_BINARY), arguments, driver);
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// What the run on that driver said.
  std::string text(const std::string& driver) const {
    std::ifstream stream(folder_ / (driver + ".log"));
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder_;
};

/// How far images are apart.
struct Difference {
  double largest = 0.0;
  double share = 0.0;  ///< of the pixels that are farther apart than roundings bring them

  void add(const Difference& other) {
    largest = std::max(largest, other.largest);
    share = std::max(share, other.share);
  }
};

/// Of the channels whose names begin with `prefix`.
Difference difference(const Image& a, const Image& b, const std::string& prefix) {
  Difference result;
  std::set<std::size_t> pixels;
  for (const auto& [name, values] : a.channels) {
    if (!name.starts_with(prefix)) continue;
    const std::vector<float>& others = b.channels.at(name);
    double mean = 0.0;
    for (float value : values) mean += static_cast<double>(value) / static_cast<double>(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == others[i]) continue;
      const double value = static_cast<double>(values[i]), other = static_cast<double>(others[i]);
      const double apart = std::abs(value - other) / std::max(mean, std::abs(value));
      result.largest = std::max(result.largest, apart);
      if (apart > k_rounding) pixels.insert(i);
    }
  }
  result.share = static_cast<double>(pixels.size()) / static_cast<double>(a.size.x * a.size.y);
  return result;
}

TEST_P(Drivers, ShowTheSameImages) {
  const std::string populations[] = {"shadow-map", "conservative", "screen-space"};
  std::string volumes, surfaces;
  for (const std::string& populate : populations) {
    for (const char* integral : {"table", "quadrature", "riemann", "factored"}) {
      volumes += fmt::format("{}vsv:populate={}:integral={}", volumes.empty() ? "" : ",", populate, integral);
    }
    surfaces += fmt::format("{}vsv:populate={}", surfaces.empty() ? "" : ",", populate);
  }
  volumes +=
      ",vsv:query=tree,march,march:spacing=angle:jitter=interleaved,march:jitter=gathered,march:look-up=rows,"
      "froxel,froxel:samples=4";
  const std::string methods[] = {fmt::format("--surface shadow-map --volume {}", volumes),
                                 fmt::format("--surface {} --volume none", surfaces)};

  int images = 0;
  Difference airlight, surface, distance;
  for (const std::string& method : methods) {
    for (const char* driver : {"default", "zink"}) {
      const std::string command = fmt::format(
          "compare {} {} -o {} --size 96x64 --alpha 128 --theta 512 --phi 256 --shadow-map 512 --frames 1 "
          "--quiet",
          GetParam(), method, driver);
      ASSERT_EQ(run(driver, command), 0) << text(driver);
    }
    for (const auto& entry : fs::directory_iterator(folder_ / "default")) {
      const fs::path name = entry.path().filename();
      if (name.extension() != ".exr" || name == "reference.exr") continue;
      SCOPED_TRACE(name);
      const Image a = quality::read_exr(entry.path()), b = quality::read_exr(folder_ / "zink" / name);
      ASSERT_EQ(a.size, b.size);
      ASSERT_GT(a.channels.size(), 5);
      ++images;
      const auto check = [&](Difference& worst, const char* channels) {
        const Difference found = difference(a, b, channels);
        EXPECT_LE(found.share, k_most_pixels) << channels;
        worst.add(found);
        return found;
      };
      EXPECT_LE(check(airlight, "airlight.").largest, k_largest_airlight);
      check(surface, "surface.");
      check(distance, "distance.");
    }
    fs::remove_all(folder_ / "default");
    fs::remove_all(folder_ / "zink");
  }
  EXPECT_EQ(images, 22);
  std::cout << fmt::format(
      "Two drivers, {}: the airlight of {} images differs by at most {:.2g}, in {:.2g} % of the pixels by "
      "more than "
      "roundings; surface shadows differ in {:.2g} %, distances in {:.2g} %\n",
      GetParam(), images, airlight.largest, 100.0 * airlight.share, 100.0 * surface.share,
      100.0 * distance.share);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Drivers,
                         testing::Values("cornell --phase henyey-greenstein --g=-0.99", "window",
                                         "spheres --triangles 2000"));

}  // namespace
}  // namespace airlight
