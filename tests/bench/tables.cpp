// Tables 2 to 4 of Wyman, "Voxelized Shadow Volumes", HPG 2011: what populate and scan cost against the size
// of the shadow map and the counts of the grid, with the exponent b of a fitted cost ∝ count^b; and populate
// + scan against what the machine can copy and write, measured in the same run.
//
// `airlight_tables [SCENE [stages]]`, a built-in scene (toroid). Times are medians of 5 frames [ms],
// 1024×1024 pixels. With `stages`, each stage of the default frame beside the bytes that it cannot do
// without.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "frame/frame.h"
#include "frame/none.h"
#include "media/vsv.h"
#include "report.h"
#include "scene/builtin.h"
#include "scene/error.h"
#include "surface_shadows/shadow_map_lookup.h"

#include <epoxy/gl.h>

namespace {

using namespace airlight;
using epipolar::Populate;
using epipolar::Scan;
using Stages = std::map<std::string, double>;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

double median_ms(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    if (i > 0)
      times.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return median(times);
}

class Bench {
 public:
  Bench(gpu::Context& context, const std::string& name) : context_(context) {
    const scene::BuiltinScene* builtin = scene::find_builtin(name);
    if (!builtin) throw scene::Error(scene::ExitCode::usage, name, "there is no such built-in scene");
    scene_ = builtin->make({});
    view_ = {scene_.cameras.at(0), {scene_.lights.at(0)}, scene_.medium, {1024, 1024}};
  }

  std::size_t triangles() const { return scene_.geometry.triangles.size(); }

  glm::ivec2 size() const { return view_.size; }

  /// Medians of the stages of a frame.
  Stages stages(const epipolar::VolumeOptions& volume, int shadow_map) {
    frame::NoShadow no_shadow;
    return stages(volume, shadow_map, no_shadow);
  }
  Stages stages(const epipolar::VolumeOptions& volume, int shadow_map, frame::SurfaceShadow& surface_shadow) {
    frame::Frame frame(context_, scene_.geometry, shadow_map);
    media::Vsv vsv(context_, {.volume = volume});
    std::map<std::string, std::vector<double>> samples;
    for (int i = 0; i < 6; ++i) {
      gpu::StageTimer timer(&context_);
      frame.render(view_, surface_shadow, vsv, timer);
      if (i == 0) continue;  // warm-up
      for (const auto& [stage, ms] : timer.milliseconds()) samples[stage].push_back(ms);
    }
    Stages stages;
    for (auto& [stage, values] : samples) stages[stage] = median(values);
    return stages;
  }

 private:
  gpu::Context& context_;
  scene::Scene scene_;
  scene::View view_;
};

/// One line of a table: a stage's time at each count, and the exponent.
void print_line(const std::string& label, const std::vector<int>& counts, const std::vector<Stages>& runs,
                const std::string& stage) {
  std::vector<double> ms;
  std::string line = fmt::format("{:<28}", label);
  for (const Stages& run : runs) {
    ms.push_back(run.at(stage));
    line += fmt::format("{:>9.1f}", ms.back());
  }
  fmt::print("{}{:>9.2f}\n", line, bench::exponent(counts, ms));
}

void print_head(const std::string& title, const std::vector<int>& counts) {
  std::string line = fmt::format("\n{:<28}", title);
  for (const int count : counts) line += fmt::format("{:>9}", count);
  fmt::print("{}{:>9}\n", line, "exponent");
}

struct Way {
  const char* label;
  Populate populate;
};
constexpr Way k_ways[] = {{"populate: shadow map", Populate::shadow_map},
                          {"populate: conservative", Populate::conservative},
                          {"populate: screen space", Populate::screen_space}};

void print_counts(Bench& bench, const char* title, int epipolar::Resolution::*count,
                  const std::vector<int>& counts) {
  print_head(title, counts);
  const auto sweep = [&](Populate populate, std::optional<Scan> scan) {
    std::vector<Stages> runs;
    for (const int n : counts) {
      epipolar::VolumeOptions volume{.populate = populate, .scan = scan};
      volume.resolution.*count = n;
      runs.push_back(bench.stages(volume, 2048));
    }
    return runs;
  };
  for (const auto& [label, populate] : k_ways) {
    const std::vector<Stages> runs = sweep(populate, {});
    print_line(label, counts, runs, "populate");
    if (populate == Populate::shadow_map) print_line("scan: fused", counts, runs, "scan");
    if (populate == Populate::screen_space) print_line("scan: column", counts, runs, "scan");
    if (populate == Populate::shadow_map) print_line("integrate", counts, runs, "integrate");
  }
  print_line("scan: multi-pass", counts, sweep(Populate::shadow_map, Scan::multi_pass), "scan");
}

/// Runs `part` on an equal share of the bytes on each of as many threads as there are cores, as llvmpipe
/// does.
double threads_ms(std::size_t bytes, const std::function<void(std::size_t, std::size_t)>& part) {
  return median_ms([&] {
    const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> running;
    for (std::size_t i = 0; i < threads; ++i)
      running.emplace_back([&, i] { part(i * (bytes / threads), bytes / threads); });
  });
}

/// Each stage of the default frame, beside the bytes that it reads and writes at least, each once, and the
/// time that the driver's copy of as many takes in the same run.
void print_stages(Bench& bench, gpu::Context& context) {
  constexpr int k_shadow_map = 1024;
  constexpr double k_table_rows = 128;  // media/vsv.cpp
  const epipolar::Resolution n;
  const double pixels = bench.size().x * bench.size().y, triangles = static_cast<double>(bench.triangles());
  const double light_rays = static_cast<double>(n.theta) * n.phi, row = n.phi / 8.0;
  struct Stage {
    const char* name;
    double bytes;
    const char* what;
    double operations;
    const char* each;
  };
  const double triangle = 3 * 12 + 12;  // positions and indices
  const Stage stages[] = {
      {"surfaces", pixels * (4 + 4 + 4 + 16) + triangles * triangle,
       "number and depth written; number read, surface written", pixels, "pixel"},
      {"shadow_map", 6.0 * k_shadow_map * k_shadow_map * 4 + triangles * triangle, "six faces written",
       triangles, "triangle"},
      {"ranges", pixels * 16, "surfaces read", pixels, "pixel"},
      {"populate", light_rays * (4 + 4), "a texel read, a number written a light ray", light_rays,
       "light ray"},
      {"scan", light_rays * (4 + n.alpha / 8.0), "numbers read, the grid written", light_rays * n.alpha / 32,
       "word"},
      {"table", k_table_rows * n.phi * 16, "written", k_table_rows * n.phi, "entry"},
      {"integrate", pixels * (16 + row + 16), "surface and a row of the grid read, airlight written", pixels,
       "pixel"},
      {"surface_query", pixels * (16 + 4 + 4), "surface and a texel read, visibility written", pixels,
       "pixel"},
      {"composite", pixels * (4 + 16 + 4 + 16 + 16), "four images read, radiance written", pixels, "pixel"}};

  const std::int64_t copied = 64 << 20;
  const gpu::Buffer a(copied), b(copied);
  const double copy_ms = median_ms([&] {
    glCopyNamedBufferSubData(a.name(), b.name(), 0, 0, copied);
    context.finish();
  });
  const double bytes_per_ms = 2.0 * static_cast<double>(copied) / copy_ms;  // read and written
  surface_shadows::ShadowMapLookup lookup;
  const Stages measured = bench.stages({}, k_shadow_map, lookup);
  fmt::print("\nThe driver copies {:.1f} GB/s, read and written.\n", bytes_per_ms * 1e-6);
  fmt::print("{:<15}{:>8}{:>8}{:>14}{:>9}  {}\n", "stage", "ms", "MB", "ms at copy", "ns each", "");
  for (const Stage& stage : stages) {
    const double ms = measured.at(stage.name);
    fmt::print("{:<15}{:>8.1f}{:>8.1f}{:>14.1f}{:>9.2f}  {}; {}\n", stage.name, ms, stage.bytes * 1e-6,
               stage.bytes / bytes_per_ms, ms * 1e6 / stage.operations, stage.each, stage.what);
  }
}

void print_bandwidth(Bench& bench, gpu::Context& context) {
  const epipolar::Resolution n;
  const auto bytes = static_cast<std::size_t>(n.alpha) * static_cast<std::size_t>(n.theta) *
                     static_cast<std::size_t>(n.phi) / 8;
  const gpu::Buffer a(static_cast<std::int64_t>(bytes)), b(static_cast<std::int64_t>(bytes));
  const double gl_copy = median_ms([&] {
    glCopyNamedBufferSubData(a.name(), b.name(), 0, 0, static_cast<GLsizeiptr>(bytes));
    context.finish();
  });
  const double gl_write = median_ms([&] {
    a.clear(0x12345678u);
    context.finish();
  });
  std::vector<char> from(bytes, 1), to(bytes, 2);
  const double copy = threads_ms(
      bytes, [&](std::size_t at, std::size_t size) { std::memcpy(to.data() + at, from.data() + at, size); });
  char value = 0;
  const double write = threads_ms(
      bytes, [&](std::size_t at, std::size_t size) { std::memset(to.data() + at, ++value, size); });
  const auto rate = [&](double ms) { return static_cast<double>(bytes) / ms / 1e6; };
  fmt::print("\nThe default grid, {:.0f} MiB\n", static_cast<double>(bytes) / 0x100000);
  const auto line = [&](const std::string& label, double ms) {
    fmt::print("{:<36}{:>8.1f} ms{:>8.1f} GB/s{:>8.1f} × copy{:>8.1f} × write\n", label, ms, rate(ms),
               ms / gl_copy, ms / gl_write);
  };
  line("copied by the driver", gl_copy);
  line("written by the driver", gl_write);
  line("copied by the CPU, all threads", copy);
  line("written by the CPU, all threads", write);
  for (const auto& [label, populate] : k_ways) {
    for (const auto& [scan_label, scan] :
         {std::pair{"fused", Scan::fused}, std::pair{"blocks", Scan::blocks},
          std::pair{"column", Scan::column}, std::pair{"multi-pass", Scan::multi_pass}}) {
      if (populate == Populate::screen_space && (scan == Scan::fused || scan == Scan::blocks)) continue;
      const Stages stages = bench.stages({.populate = populate, .scan = scan}, 1024);
      line(fmt::format("{}, {}", label, scan_label), stages.at("populate") + stages.at("scan"));
      line("  of it the scan", stages.at("scan"));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    gpu::Context context;
    const std::string name = argc > 1 ? argv[1] : "toroid";
    Bench bench(context, name);
    fmt::print("{}, {} triangles; {}\n", name, bench.triangles(), context.device().renderer);
    if (argc > 2 && argv[2] == std::string("stages")) {
      print_stages(bench, context);
      return 0;
    }

    const std::vector<int> sizes = {512, 1024, 2048, 4096};
    print_head("shadow map size", sizes);
    std::vector<Stages> runs;
    for (const int size : sizes) runs.push_back(bench.stages({}, size));
    print_line("shadow map", sizes, runs, "shadow_map");
    print_line("populate: shadow map", sizes, runs, "populate");

    print_counts(bench, "N_theta", &epipolar::Resolution::theta, {128, 256, 512, 1024, 2048});
    print_counts(bench, "N_alpha", &epipolar::Resolution::alpha, {64, 128, 256, 512, 1024});
    print_counts(bench, "N_phi", &epipolar::Resolution::phi, {128, 256, 512, 1024});
    print_bandwidth(bench, context);
  } catch (const scene::Error& error) {
    fmt::print(stderr, "airlight_tables: {}\n", error.what());
    return static_cast<int>(error.exit_code);
  }
}
