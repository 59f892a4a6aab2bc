// How fast the window is while something moves, without one: `airlight_viewer_bench [SCENE.toml|NAME]
// [FRAMES]`, 1280×720 pixels.
//
// The camera turns about its target, then the first light moves, each for FRAMES frames of the panels and the
// picture; printed are the frames a second of the second half, when the ladder has found its rung, that
// rung's size, the time at rest, and memory.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "gpu/context.h"
#include "quality/light_texture.h"
#include "scene/builtin.h"
#include "scene/shot.h"
#include "viewer/cameras.h"
#include "viewer/viewer.h"

namespace {

using namespace airlight;
using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double resident_mib() {
  std::ifstream statm("/proc/self/statm");
  long total = 0, pages = 0;
  statm >> total >> pages;
  return static_cast<double>(pages * sysconf(_SC_PAGESIZE)) / 1048576.0;
}

struct Moving {
  double frames_per_second;
  double worst_ms;
  std::size_t rung;
};

/// @param step what happens before a frame
template <typename Step>
Moving move(viewer::Viewer& viewer, double& now, gpu::Context& context, int frames, const Step& step) {
  double ms = 0.0, worst = 0.0;
  std::size_t rung = 0;
  for (int i = 0; i < frames; ++i) {
    step(i);
    const auto start = Clock::now();
    viewer.draw(now);
    context.finish();
    const double of_frame = milliseconds_since(start);
    now += of_frame / 1e3;
    if (i < frames / 2) continue;
    ms += of_frame;
    worst = std::max(worst, of_frame);
    rung = viewer.rung();
  }
  return {1e3 * (frames - frames / 2) / ms, worst, rung};
}

int run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "window";
  const int frames = argc > 2 ? std::stoi(argv[2]) : 120;
  const scene::BuiltinScene* builtin = scene::find_builtin(name);
  const scene::Scene scene =
      builtin ? builtin->make({}) : scene::load_shot(name, {}, quality::read_light_texture);
  scene::View view{scene.cameras.at(0), scene.lights, scene.medium, {1280, 720}};
  gpu::Context context;
  viewer::Viewer viewer(context, scene, {name, {}, {}},
                        {view, quality::parse_volumes("vsv")[0], quality::parse_surfaces("shadow-map")[0],
                         2048, scene.exposure.value_or(1.0f)},
                        std::nullopt, "out");
  double now = 0.0;
  viewer.push(viewer::SizeEvent{view.size, view.size});
  const auto settle = [&] {
    now += 1.0;
    for (int i = 0; i < 100 && (i < 3 || viewer.has_work(now)); ++i) viewer.draw(now += 0.05);
  };
  settle();
  const double settled = resident_mib();

  // Panels alone: the cursor moves over the picture.
  const Moving panels = move(viewer, now, context, 20, [&](int i) {
    viewer.push(viewer::CursorEvent{{600 + i, 300}});
  });
  // The left button takes the light, where it is seen.
  const scene::CameraFrame frame = scene::camera_frame(viewer.shown().view.camera, view.size);
  const scene::Light& light = viewer.shown().view.lights[0];
  const glm::dvec2 place(viewer::project(frame, view.size, light));
  viewer.push(viewer::CursorEvent{place});
  viewer.push(viewer::ButtonEvent{0, true});
  viewer.draw(now);
  const Moving lamp = move(viewer, now, context, frames, [&](int i) {
    viewer.push(viewer::CursorEvent{place + glm::dvec2(2.0 * std::abs(i % 40 - 20), 0)});
  });
  viewer.push(viewer::ButtonEvent{0, false});
  settle();
  // The right button goes round the target.
  viewer.push(viewer::CursorEvent{{700, 400}});
  viewer.push(viewer::ButtonEvent{1, true});
  viewer.draw(now);
  const Moving camera = move(viewer, now, context, frames, [&](int i) {
    const double way = 2.0 * std::abs(i % 40 - 20);
    viewer.push(viewer::CursorEvent{{700 + way, 400}});
  });
  viewer.push(viewer::ButtonEvent{1, false});
  settle();
  fmt::print(
      "{}, {}: panels {:.1f} frames a second, camera {:.1f} frames a second at rung {} (worst frame {:.0f} "
      "ms), light {:.1f} at rung {} "
      "({:.0f} ms); "
      "{:.0f} MiB when settled, {:.0f} MiB after {} frames\n",
      name, context.device().renderer, panels.frames_per_second, camera.frames_per_second, camera.rung,
      camera.worst_ms, lamp.frames_per_second, lamp.rung, lamp.worst_ms, settled, resident_mib(), 2 * frames);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "airlight_viewer_bench: {}\n", error.what());
    return 1;
  }
}
