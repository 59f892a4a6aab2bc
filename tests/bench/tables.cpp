// Tables 2 to 4 of Wyman, "Voxelized Shadow Volumes", HPG 2011: what populate and scan cost against the size
// of the shadow map and the counts of the grid, with the exponent b of a fitted cost ∝ count^b; and populate
// + scan against what the machine can copy and write, measured in the same run.
//
// `airlight_tables [SCENE]`, a built-in scene (toroid). Times are medians of 5 frames [ms], 1024×1024 pixels.
#include <algorithm>
#include <chrono>
#include <cmath>
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
#include "scene/builtin.h"
#include "scene/error.h"

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

  /// Medians of the stages of a frame.
  Stages stages(const epipolar::VolumeOptions& volume, int shadow_map) {
    frame::Frame frame(context_, scene_.geometry, shadow_map);
    media::Vsv vsv(context_, {.volume = volume});
    frame::NoShadow no_shadow;
    std::map<std::string, std::vector<double>> samples;
    for (int i = 0; i < 6; ++i) {
      gpu::StageTimer timer(&context_);
      frame.render(view_, no_shadow, vsv, timer);
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

/// The slope of log(ms) over log(count).
double exponent(const std::vector<int>& counts, const std::vector<double>& ms) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double a = std::log(counts[i]), b = std::log(ms[i]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// One line of a table: a stage's time at each count, and the exponent.
void print_line(const std::string& label, const std::vector<int>& counts, const std::vector<Stages>& runs,
                const std::string& stage) {
  std::vector<double> ms;
  std::string line = fmt::format("{:<28}", label);
  for (const Stages& run : runs) {
    ms.push_back(run.at(stage));
    line += fmt::format("{:>9.1f}", ms.back());
  }
  fmt::print("{}{:>9.2f}\n", line, exponent(counts, ms));
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
    for (const auto& [scan_label, scan] : {std::pair{"fused", Scan::fused}, std::pair{"column", Scan::column},
                                           std::pair{"multi-pass", Scan::multi_pass}}) {
      if (populate == Populate::screen_space && scan == Scan::fused) continue;
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
