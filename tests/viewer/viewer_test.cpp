// The window as a person uses it, without one: events go in, and the image is looked at.
#include "viewer/viewer.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "quality/image_io.h"
#include "support/gpu_context.h"
#include "support/paths.h"
#include "support/scenes.h"
#include "support/shader_folder.h"
#include "viewer/cameras.h"

namespace airlight::viewer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// With room for the panels.
constexpr glm::ivec2 k_tall{420, 800};

class Viewers : public testing::Test {
 protected:
  ~Viewers() override {
    viewer_.reset();
    fs::remove_all(folder_);
  }

  void start(const std::string& scene, glm::ivec2 size = {256, 144}) {
    const scene::Scene& of_name = tests::builtin(scene);
    scene::View view = tests::view_of(of_name, size);
    viewer_.emplace(tests::gpu_context(), of_name, SceneName{scene, {}, {}},
                    Shown{view, quality::parse_volumes("vsv:alpha=64:theta=256:phi=128")[0],
                          quality::parse_surfaces("shadow-map")[0], 256, of_name.exposure},
                    std::nullopt, folder_);
    push(SizeEvent{size, size});
    frames(3);
  }

  template <typename E>
  void push(const E& event) {
    viewer_->push(Event(event));
  }
  /// Frames as a screen asks for them.
  void frames(int count) {
    for (int i = 0; i < count; ++i) viewer_->draw(now_ += 1.0 / 60.0);
  }
  /// Until there is nothing left to do.
  void rest() {
    now_ += 1.0;
    for (int i = 0; i < 400 && (i < 3 || viewer_->has_work(now_)); ++i) {
      frames(1);
      if (viewer_->has_work(now_)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      now_ += 0.05;
    }
    EXPECT_FALSE(viewer_->has_work(now_));
  }
  void key(int code) {
    push(KeyEvent{code, true});
    push(KeyEvent{code, false});
    frames(2);
  }
  void hold(int code, int count) {
    push(KeyEvent{code, true});
    frames(count);
    push(KeyEvent{code, false});
    frames(1);
  }
  glm::dvec2 place(const std::string& control) {
    const auto found = viewer_->controls().find(control);
    if (found == viewer_->controls().end()) {
      ADD_FAILURE() << "no control " << control;
      return {1, 1};
    }
    return 0.5 * (found->second.from + found->second.to);
  }
  void click(glm::dvec2 at) {
    push(CursorEvent{at});
    frames(1);
    push(ButtonEvent{0, true});
    push(ButtonEvent{0, false});
    frames(4);
  }
  void click(const std::string& control) { click(place(control)); }
  void drag(glm::dvec2 from, glm::dvec2 to, int button = 0) {
    push(CursorEvent{from});
    frames(1);
    push(ButtonEvent{button, true});
    frames(1);
    for (int i = 1; i <= 4; ++i) {
      push(CursorEvent{from + (to - from) * (i / 4.0)});
      frames(1);
    }
    push(ButtonEvent{button, false});
    frames(2);
  }
  /// Row 0 at the top, in 256ths.
  std::vector<glm::ivec3> pixels() {
    const glm::ivec2 size = viewer_->image().size();
    const auto values = viewer_->image().read<glm::vec4>();
    std::vector<glm::ivec3> pixels;
    for (int y = size.y - 1; y >= 0; --y)
      for (int x = 0; x < size.x; ++x)
        pixels.emplace_back(glm::round(255.0f * glm::vec3(values[static_cast<std::size_t>(y * size.x + x)])));
    return pixels;
  }
  fs::path file(const std::string& ending) {
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().string().ends_with(ending)) return entry.path();
    ADD_FAILURE() << "no file " << ending;
    return {};
  }

  /// Runs a command of the program in the folder.
  void run(const std::string& command) {
    fs::create_directories(folder_);
    const std::string line = fmt::format("cd '{}' && {}{} --quiet", folder_.string(), AIRLIGHT_BUILT_BINARY,
                                         command.substr(std::string("airlight").size()));
    ASSERT_EQ(std::system(line.c_str()), 0) << line;
  }
  /// The picture above the status line is what `render` has written.
  void expect_shown(const fs::path& image) {
    const quality::Image rendered = quality::read_exr(image);
    const glm::ivec2 size = rendered.size;
    ASSERT_EQ(size, viewer_->image().size());
    const float exposure = viewer_->shown().exposure.value();
    const std::vector<glm::ivec3> shown = pixels();
    int compared = 0;
    for (int y = 0; y < size.y - 24; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const auto i = static_cast<std::size_t>(y * size.x + x);
        for (int c = 0; c < 3; ++c) {
          const float linear =
              std::clamp(exposure * rendered.channels.at(std::string(1, "RGB"[c]))[i], 0.0f, 1.0f);
          const float srgb =
              linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
          // The driver's pow, and where a value lies half-way between two.
          ASSERT_NEAR(static_cast<float>(shown[i][c]), 255.0f * srgb, 0.75f) << x << " " << y;
          compared += linear > 0.0f ? 1 : 0;
        }
      }
    }
    EXPECT_GT(compared, 10000);
  }

  fs::path folder_ = fs::temp_directory_path() / fmt::format("airlight-viewer-{}", getpid());
  std::optional<Viewer> viewer_;
  double now_ = 0.0;
};

TEST_F(Viewers, ShowTheImageOfTheCommandThatTheyCopy) {
  start("window");
  key(GLFW_KEY_F2);  // the panels away
  drag({150, 70}, {190, 60});
  push(ScrollEvent{2.0});
  rest();
  EXPECT_EQ(viewer_->rung(), 0u);
  run(viewer_->command());
  expect_shown(folder_ / "picture.exr");
}

TEST_F(Viewers, DrawNothingAtRest) {
  start("window");
  rest();
  const scene::Camera camera = viewer_->shown().view.camera;
  EXPECT_FALSE(viewer_->has_work(now_));
  push(CursorEvent{{200, 100}});
  EXPECT_TRUE(viewer_->has_work(now_));
  rest();
  EXPECT_EQ(viewer_->shown().view.camera, camera);
}

TEST_F(Viewers, FlyByKeys) {
  start("window");
  const scene::Camera before = viewer_->shown().view.camera;
  const glm::dvec3 ahead = glm::normalize(before.target - before.eye);
  hold(GLFW_KEY_W, 5);
  const glm::dvec3 moved = viewer_->shown().view.camera.eye - before.eye;
  EXPECT_GT(glm::dot(moved, ahead), 0.01);
  EXPECT_NEAR(glm::length(moved - glm::dot(moved, ahead) * ahead), 0.0, 1e-9);
  hold(GLFW_KEY_E, 3);
  EXPECT_GT(viewer_->shown().view.camera.eye.y, before.eye.y + moved.y);
  // A key that went down and up between two frames was down for one.
  const glm::dvec3 here = viewer_->shown().view.camera.eye;
  key(GLFW_KEY_A);
  EXPECT_NE(viewer_->shown().view.camera.eye, here);
  key(GLFW_KEY_HOME);
  EXPECT_EQ(viewer_->shown().view.camera, before);
  // What is held when the window loses the focus is not held any more.
  push(KeyEvent{GLFW_KEY_W, true});
  frames(1);
  push(FocusEvent{false});
  frames(1);
  const glm::dvec3 left = viewer_->shown().view.camera.eye;
  frames(3);
  EXPECT_EQ(viewer_->shown().view.camera.eye, left);
}

TEST_F(Viewers, LookOrbitPanAndDolly) {
  start("window");
  key(GLFW_KEY_F2);
  const scene::Camera before = viewer_->shown().view.camera;
  drag({150, 70}, {170, 70}, 0);
  EXPECT_EQ(viewer_->shown().view.camera.eye, before.eye);
  EXPECT_NE(viewer_->shown().view.camera.target, before.target);
  key(GLFW_KEY_HOME);
  // So fast that all happens between two frames.
  push(CursorEvent{{150, 70}});
  push(ButtonEvent{0, true});
  push(CursorEvent{{160, 70}});
  push(CursorEvent{{170, 70}});
  push(ButtonEvent{0, false});
  frames(4);
  EXPECT_NE(viewer_->shown().view.camera.target, before.target);
  key(GLFW_KEY_HOME);
  drag({150, 70}, {170, 70}, 1);
  EXPECT_EQ(viewer_->shown().view.camera.target, before.target);
  EXPECT_NE(viewer_->shown().view.camera.eye, before.eye);
  key(GLFW_KEY_HOME);
  push(KeyEvent{GLFW_KEY_LEFT_SHIFT, true});
  drag({150, 70}, {170, 70}, 2);
  push(KeyEvent{GLFW_KEY_LEFT_SHIFT, false});
  frames(1);
  EXPECT_NE(viewer_->shown().view.camera.target, before.target);
  key(GLFW_KEY_HOME);
  push(CursorEvent{{150, 70}});
  frames(1);
  push(ScrollEvent{1.0});
  frames(2);
  EXPECT_LT(glm::distance(viewer_->shown().view.camera.eye, before.target),
            glm::distance(before.eye, before.target));
}

TEST_F(Viewers, DragALampWhereItIsSeen) {
  start("spheres");
  key(GLFW_KEY_F2);  // the panels away
  // The lamp in the middle of the image, and from there to where the cursor goes.
  const scene::Light before = viewer_->shown().view.lights[0];
  const scene::CameraFrame frame = scene::camera_frame(viewer_->shown().view.camera, {256, 144});
  const glm::dvec3 relative = before.position - frame.eye;
  const double depth = glm::dot(relative, frame.forward);
  if (depth <= 0.0) GTEST_SKIP() << "the lamp is behind the eye";
  const glm::dvec2 seen(128.0 * (1.0 + glm::dot(relative, frame.right) / depth / frame.half_width),
                        72.0 * (1.0 - glm::dot(relative, frame.up) / depth / frame.half_height));
  drag(seen, seen + glm::dvec2(20, 10));
  const glm::dvec3 after = viewer_->shown().view.lights[0].position - frame.eye;
  EXPECT_NEAR(glm::dot(after, frame.forward), depth, 1e-9 * depth);
  EXPECT_NEAR(128.0 * (1.0 + glm::dot(after, frame.right) / depth / frame.half_width), seen.x + 20.0, 1e-6);
  EXPECT_NEAR(72.0 * (1.0 - glm::dot(after, frame.up) / depth / frame.half_height), seen.y + 10.0, 1e-6);
  EXPECT_EQ(viewer_->shown().view.camera, viewer_->shown().view.camera);
}

TEST_F(Viewers, TakeALightAtTheEyeAndSayWhy) {
  start("window");
  rest();
  scene::View view = viewer_->shown().view;
  // By the panel: the camera is where the lamp is.
  const scene::Scene& scene = tests::builtin("window");
  view.camera.eye = view.lights[0].position;
  view.camera.target = view.camera.eye + glm::dvec3(1, 0, 0);
  viewer_.emplace(tests::gpu_context(), scene, SceneName{"window", {}, {}},
                  Shown{view, quality::parse_volumes("vsv:alpha=64:theta=256:phi=128")[0],
                        quality::parse_surfaces("shadow-map")[0], 256, 1.0f},
                  std::nullopt, folder_);
  push(SizeEvent{{128, 72}, {128, 72}});
  frames(3);
  EXPECT_THAT(viewer_->message(), HasSubstr("eye"));
  // Away from it, the picture comes back.
  hold(GLFW_KEY_W, 5);
  rest();
  EXPECT_EQ(viewer_->message(), "");
}

TEST_F(Viewers, FollowTheWindow) {
  start("window");
  rest();
  push(SizeEvent{{160, 90}, {320, 180}});  // a fine screen
  rest();
  EXPECT_EQ(viewer_->image().size(), glm::ivec2(320, 180));
  EXPECT_EQ(viewer_->shown().view.size, glm::ivec2(320, 180));
  push(SizeEvent{{0, 0}, {0, 0}});  // minimised
  EXPECT_FALSE(viewer_->draw(now_ += 0.1));
  EXPECT_FALSE(viewer_->has_work(now_));
  push(SizeEvent{{100, 90}, {100, 90}});
  rest();
  EXPECT_EQ(viewer_->image().size(), glm::ivec2(100, 90));
}

TEST_F(Viewers, ShowTheTruthBesideAndItsDistance) {
  start("window", {96, 54});
  viewer_->set_beside(Beside::truth, Layout::split);
  rest();
  ASSERT_TRUE(viewer_->truth_error().has_value());
  EXPECT_GT(*viewer_->truth_error(), 1e-3);  // of a grid as coarse as that
  EXPECT_LT(*viewer_->truth_error(), 0.3);
  // It goes when something moves.
  hold(GLFW_KEY_W, 2);
  EXPECT_FALSE(viewer_->truth_error().has_value());
}

TEST_F(Viewers, SetMethodsAndTheirOptions) {
  start("window", k_tall);
  click("volume-options");
  click("volumethetax2");
  EXPECT_EQ(spec_of(viewer_->shown().volume), "vsv:alpha=64:theta=512:phi=128");
  click("volumephi/2");  // already the least
  EXPECT_EQ(spec_of(viewer_->shown().volume), "vsv:alpha=64:theta=512:phi=128");
  click("volumewhere");
  click("volumewhere=half");
  EXPECT_EQ(spec_of(viewer_->shown().volume), "vsv:alpha=64:theta=512:phi=128:where=half");
  // What contradicts the others is refused, and said.
  click("volumescan");
  click("volumescan=none");
  EXPECT_THAT(viewer_->message(), HasSubstr("scan"));
  EXPECT_EQ(spec_of(viewer_->shown().volume), "vsv:alpha=64:theta=512:phi=128:where=half");
  // A number is typed.
  click("volumealpha");
  push(KeyEvent{GLFW_KEY_LEFT_CONTROL, true});
  key(GLFW_KEY_A);
  push(KeyEvent{GLFW_KEY_LEFT_CONTROL, false});
  frames(1);
  for (const char c : std::string("100")) push(CharacterEvent{static_cast<unsigned>(c)});
  key(GLFW_KEY_ENTER);
  EXPECT_EQ(spec_of(viewer_->shown().volume), "vsv:alpha=100:theta=512:phi=128:where=half");
  click("volume");
  click("volume=froxel");
  EXPECT_EQ(spec_of(viewer_->shown().volume), "froxel");
  click("surface");
  click("surface=psv");
  EXPECT_EQ(spec_of(viewer_->shown().surface), "psv");
  frames(3);
}

TEST_F(Viewers, SetFogLightsAndCamera) {
  start("window", k_tall);
  for (const char* open : {"Methods", "Beside", "Picture", "Fog"}) click(open);
  const scene::Medium fog = viewer_->shown().view.medium;
  drag(place("density"), place("density") + glm::dvec2(20, 0));
  EXPECT_NE(viewer_->shown().view.medium.sigma_s, fog.sigma_s);
  click("medium-phase");
  click("medium-phase=henyey-greenstein");
  EXPECT_EQ(viewer_->shown().view.medium.phase, scene::PhaseFunction::henyey_greenstein);
  drag(place("medium-g"), place("medium-g") + glm::dvec2(40, 0));
  EXPECT_GT(viewer_->shown().view.medium.g, 0.0f);
  click("medium-fog-top");
  EXPECT_TRUE(viewer_->shown().view.medium.top.has_value());
  click("no-top");
  EXPECT_FALSE(viewer_->shown().view.medium.top.has_value());
  click("Fog");

  click("Lights");
  click("add-sun");
  ASSERT_EQ(viewer_->shown().view.lights.size(), 2u);
  EXPECT_TRUE(scene::is_sun(viewer_->shown().view.lights[1]));
  click("light0-on");
  ASSERT_EQ(viewer_->shown().view.lights.size(), 1u);
  click("light0-on");  // the last one stays
  EXPECT_EQ(viewer_->shown().view.lights.size(), 1u);
  EXPECT_THAT(viewer_->message(), HasSubstr("one light"));
  const glm::dvec3 towards = viewer_->shown().view.lights[0].towards;
  click(place("light0-hour") - glm::dvec2(30, 0));
  EXPECT_NE(viewer_->shown().view.lights[0].towards, towards);
  click("off-light0");
  EXPECT_EQ(viewer_->shown().view.lights.size(), 2u);
  click("add-lamp");
  EXPECT_EQ(viewer_->shown().view.lights.size(), 3u);
  click("Lights");

  click("Camera");
  drag(place("camera-fov"), place("camera-fov") + glm::dvec2(15, 0));
  EXPECT_GT(viewer_->shown().view.camera.vertical_fov_degrees,
            tests::builtin("window").cameras[0].vertical_fov_degrees);
  rest();
}

TEST_F(Viewers, RecordAPathAndPlayIt) {
  start("window", k_tall);
  for (const char* open : {"Methods", "Beside", "Picture", "Path"}) click(open);
  click("key");
  hold(GLFW_KEY_W, 6);
  const glm::dvec3 second = viewer_->shown().view.camera.eye;
  key(GLFW_KEY_K);
  click("save-path");
  EXPECT_THAT(viewer_->message(), HasSubstr("space"));
  file("_path.toml");
  key(GLFW_KEY_SPACE);
  frames(30);
  const glm::dvec3 on_its_way = viewer_->shown().view.camera.eye;
  EXPECT_GT(glm::distance(on_its_way, second), 1e-3);
  key(GLFW_KEY_SPACE);
  const glm::dvec3 paused = viewer_->shown().view.camera.eye;
  frames(5);
  EXPECT_EQ(viewer_->shown().view.camera.eye, paused);
  click(place("path-time") + glm::dvec2(30, 0));
  EXPECT_NE(viewer_->shown().view.camera.eye, paused);
  rest();
}

TEST_F(Viewers, RecordALampThatMovesAsRenderShowsIt) {
  start("spheres", k_tall);
  const scene::View view = viewer_->shown().view;
  for (const char* open : {"Methods", "Beside", "Picture", "Path"}) click(open);
  key(GLFW_KEY_K);
  key(GLFW_KEY_F2);  // the panels away
  const auto lamp = [&] {
    const scene::View& shown = viewer_->shown().view;
    return glm::dvec2(project(scene::camera_frame(shown.camera, k_tall), k_tall, shown.lights[0]));
  };
  drag(lamp(), lamp() + glm::dvec2(40, -60));
  hold(GLFW_KEY_W, 4);
  const scene::View second = viewer_->shown().view;
  ASSERT_NE(second.lights[0].position, view.lights[0].position);
  key(GLFW_KEY_F2);
  key(GLFW_KEY_K);
  // What happens after its last key is not the path's.
  key(GLFW_KEY_F2);
  drag(lamp(), lamp() - glm::dvec2(30, 0));
  key(GLFW_KEY_F2);
  frames(1);
  click("save-path");
  const fs::path path_file = file("_path.toml");
  EXPECT_EQ(viewer_->message(), path_file.string() + " written; space plays it");
  click("key1-go");
  EXPECT_EQ(viewer_->shown().view.lights, second.lights);
  EXPECT_EQ(viewer_->shown().view.camera, second.camera);

  push(SizeEvent{{160, 120}, {160, 120}});
  key(GLFW_KEY_F2);
  key(GLFW_KEY_SPACE);
  frames(30);
  key(GLFW_KEY_SPACE);
  rest();
  const scene::Path path = scene::load_path(path_file, view);
  ASSERT_EQ(path.views.size(), 61u);
  EXPECT_EQ(path.views.front().lights, view.lights);
  EXPECT_EQ(path.views.back().lights, second.lights);
  std::size_t at = 0;
  while (at < 61 && path.views[at].lights != viewer_->shown().view.lights) ++at;
  ASSERT_LT(at, 60u) << "the window plays other lights than the file has";
  EXPECT_GT(at, 5u);
  EXPECT_EQ(path.views[at].camera, viewer_->shown().view.camera);
  run(fmt::format(
      "airlight render spheres --size 160x120 --volume {} --shadow-map 256 --path {} -o played.exr",
      spec_of(viewer_->shown().volume), path_file.filename().string()));
  expect_shown(folder_ / fmt::format("played{}.exr", scene::frame_ending(at)));
}

TEST_F(Viewers, RecordNoKeyOfOtherLights) {
  start("window", k_tall);
  for (const char* open : {"Methods", "Beside", "Picture", "Path", "Lights"}) click(open);
  key(GLFW_KEY_K);
  click("add-lamp");
  key(GLFW_KEY_K);
  EXPECT_THAT(viewer_->message(), HasSubstr("no key"));
  // All keys with the lamp: then it is a path for what a shot keeps.
  click("Lights");
  click("key0-x");
  key(GLFW_KEY_K);
  hold(GLFW_KEY_W, 3);
  key(GLFW_KEY_K);
  click("save-path");
  EXPECT_THAT(viewer_->message(), HasSubstr("Ctrl + S"));
  key(GLFW_KEY_SPACE);
  frames(5);
  EXPECT_EQ(viewer_->shown().view.lights.size(), 2u);
  key(GLFW_KEY_SPACE);
  rest();
}

TEST_F(Viewers, LookIntoTheMethod) {
  start("window", k_tall);
  click("slice");
  push(CursorEvent{{380, 600}});
  rest();
  const std::vector<glm::ivec3> without = pixels();
  click("over");
  rest();
  click("over=changes");
  rest();
  const std::vector<glm::ivec3> changes = pixels();
  EXPECT_NE(changes, without);
  click("over");
  click("over=surfaces");
  rest();
  // Yellow or red somewhere, and grey for the most part.
  int coloured = 0, grey = 0;
  for (const glm::ivec3& pixel : pixels()) {
    coloured += pixel.r > pixel.b + 100 ? 1 : 0;
    grey += pixel.r == pixel.g && pixel.g == pixel.b ? 1 : 0;
  }
  EXPECT_GT(coloured, 10);
  EXPECT_GT(grey, 100000);
  key(GLFW_KEY_O);
  push(KeyEvent{GLFW_KEY_Z, true});
  frames(2);
  push(KeyEvent{GLFW_KEY_Z, false});
  key(GLFW_KEY_P);
  key(GLFW_KEY_F1);
  hold(GLFW_KEY_D, 2);
  rest();
}

TEST_F(Viewers, SurviveEveryControl) {
  start("window", k_tall);
  const std::vector<std::string> sections = {"Methods", "Beside", "Picture", "Fog",
                                             "Lights",  "Camera", "Path"};
  for (const char* open : {"Methods", "Beside", "Picture"}) click(open);
  std::set<std::string> seen;
  for (const std::string& section : sections) {
    click(section);
    // Controls may open others.
    for (int round = 0; round < 60; ++round) {
      std::string next;
      for (const auto& [name, at] : viewer_->controls())
        if (!seen.contains(name) && !testing::Value(sections, testing::Contains(name))) next = name;
      if (next.empty()) break;
      seen.insert(next);
      drag(place(next) - glm::dvec2(2, 0), place(next) + glm::dvec2(2, 0));
      if (viewer_->shown().view.lights.size() > 3) break;
    }
    rest();
    if (viewer_->controls().contains(section)) click(section);
  }
  EXPECT_GT(seen.size(), 60u);
  EXPECT_EQ(viewer_->image().size(), k_tall);
}

TEST_F(Viewers, DivideThePictureWhereTheDividerIsDragged) {
  start("window");
  key(GLFW_KEY_F2);
  viewer_->set_beside(Beside::method, Layout::split);
  rest();
  const std::vector<glm::ivec3> both = pixels();
  drag({128, 100}, {20, 100});
  rest();
  const std::vector<glm::ivec3> right = pixels();
  drag({20, 100}, {250, 100});
  rest();
  const std::vector<glm::ivec3> left = pixels();
  // Pixels left of the middle were those of the left image, and those right of it of the other one.
  int differing = 0;
  for (int y = 0; y < 118; ++y) {
    for (int x = 30; x < 240; ++x) {
      if (std::abs(x - 128) < 10) continue;
      const auto i = static_cast<std::size_t>(y * 256 + x);
      EXPECT_EQ(both[i], x < 128 ? left[i] : right[i]) << x << " " << y;
      differing += left[i] != right[i] ? 1 : 0;
    }
  }
  EXPECT_GT(differing, 100);
}

TEST_F(Viewers, GrowByNothingOverManyFrames) {
  start("window");
  key(GLFW_KEY_F2);
  const auto resident = [] {
    std::ifstream statm("/proc/self/statm");
    long total = 0, pages = 0;
    statm >> total >> pages;
    return static_cast<double>(pages * sysconf(_SC_PAGESIZE)) / 1048576.0;
  };
  const auto fly_about = [&](int rounds) {
    for (int i = 0; i < rounds; ++i) {
      drag({150, 70}, {170, 75}, 1);
      drag({170, 75}, {150, 70}, 1);
    }
    rest();
  };
  fly_about(5);
  const double before = resident();
  const std::int64_t on_gpu = viewer_->bytes();
  fly_about(15);
  EXPECT_LT(resident(), before + 16.0);  // MiB; what an allocator keeps
  EXPECT_EQ(viewer_->bytes(), on_gpu);
}

TEST_F(Viewers, ReloadShadersWhoseSourcesHaveChanged) {
  const tests::ShaderFolder shaders;
  const tests::EnvironmentValue named("AIRLIGHT_SHADERS", shaders.path().string());
  start("window");
  key(GLFW_KEY_F2);
  rest();
  // Above the status line, whose messages have up to four lines.
  const auto picture = [&] {
    std::vector<glm::ivec3> above = pixels();
    above.resize(256 * 84);
    return above;
  };
  const std::vector<glm::ivec3> before = picture();
  const int drawn = viewer_->pictures_drawn();
  key(GLFW_KEY_F5);
  EXPECT_EQ(viewer_->message(), "no shader has changed");
  rest();
  EXPECT_EQ(viewer_->pictures_drawn(), drawn);
  EXPECT_EQ(picture(), before);

  // What brings the picture to the screen, …
  shaders.replace("viewer/develop.frag", "vec4(srgb_of(", "vec4(1.0 - srgb_of(");
  key(GLFW_KEY_F5);
  EXPECT_EQ(viewer_->message(), "viewer/develop.frag reloaded");
  rest();
  const std::vector<glm::ivec3> negative = picture();
  for (std::size_t i = 0; i < before.size(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(negative[i][c], 255 - before[i][c], 1) << i;

  // … and what draws it: without airlight surfaces are left.
  const std::string composite = shaders.read("frame/composite.frag");
  shaders.replace("frame/composite.frag", "texelFetch(airlight_image, pixel, 0).rgb, 1.0)",
                  "vec3(0.0), 1.0)");
  key(GLFW_KEY_F5);
  EXPECT_EQ(viewer_->message(), "frame/composite.frag reloaded");
  rest();
  const std::vector<glm::ivec3> clear = picture();
  EXPECT_NE(clear, negative);

  // One that does not compile changes nothing.
  shaders.replace("frame/composite.frag", "void main() {", "void main() { nothing();");
  key(GLFW_KEY_F5);
  EXPECT_THAT(viewer_->message(),
              testing::AllOf(HasSubstr("frame/composite.frag: it does not compile"), HasSubstr("'nothing'")));
  rest();
  EXPECT_EQ(picture(), clear);

  shaders.write("frame/composite.frag", composite);
  shaders.replace("viewer/develop.frag", "1.0 - srgb_of(", "srgb_of(");
  key(GLFW_KEY_F5);
  EXPECT_EQ(viewer_->message(), "2 shaders reloaded");
  rest();
  EXPECT_EQ(picture(), before);
}

TEST_F(Viewers, SaveShotsPicturesAndPaths) {
  start("window");
  key(GLFW_KEY_F12);
  EXPECT_THAT(viewer_->message(), HasSubstr("written"));
  const quality::Image saved = quality::read_exr(file("_001.exr"));
  EXPECT_EQ(saved.size, glm::ivec2(256, 144));
  EXPECT_TRUE(fs::exists(file("_001.png")));
  // It says of itself what render says of the same image.
  run(viewer_->command());
  quality::Image rendered = quality::read_exr(file("picture.exr"));
  EXPECT_EQ(saved.metadata.at("airlight.command"), viewer_->command());
  rendered.metadata["airlight.command"] = viewer_->command();  // the same, spelt as it was typed
  EXPECT_EQ(saved.metadata, rendered.metadata);
  EXPECT_EQ(saved.channels, rendered.channels);
  push(KeyEvent{GLFW_KEY_LEFT_CONTROL, true});
  key(GLFW_KEY_S);
  push(KeyEvent{GLFW_KEY_LEFT_CONTROL, false});
  frames(1);
  EXPECT_TRUE(fs::exists(file(".toml")));
}

}  // namespace
}  // namespace airlight::viewer
