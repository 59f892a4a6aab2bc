// How exact surface shadows grow with the number of triangles, and the cases that are hard on a tree.
//
// `airlight_exact_growth [--size N] [--cluster N] CASE COUNT...`: of each count of triangles, on N×N pixels
// (default 512), a line a method: the times of its build and of its query, nodes a pixel, the most, triangles
// asked, the memory. `psv` and `metric-tree` (clusters of `--cluster` triangles, and how long these took);
// Embree, eight rays a packet on all cores; the shadow cube of 2048². Cases:
// - `spheres`: the built-in scene of a hundred spheres about a lamp;
// - `strip`, `strip-in-order`: triangles side by side around the light, each of which has all others outside
//   of two of its planes, inserted in random order and in theirs (Gerhards et al. 2015, Fig. 4 a);
// - `star`: slivers through one point, of which each intersects the planes of all others (Fig. 4 b).
// What the driver has no room for is said, and the other methods go on.
// With `--check` every answer is compared with `brute`'s.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "counted.h"
#include "frame/frame.h"
#include "frame/none.h"
#include "frame/point_reader.h"
#include "gpu/context.h"
#include "quality/statistics.h"
#include "report.h"
#include "scene/builtin.h"
#include "scene/error.h"
#include "scene/parallel.h"
#include "support/scenes.h"
#include "surface_shadows/brute.h"
#include "surface_shadows/metric_tree.h"
#include "surface_shadows/psv.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace {

using namespace airlight;

constexpr int k_repeats = 5;

double milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median_ms(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < k_repeats; ++i) times.push_back(milliseconds(work));
  return quality::median(times);
}

/// Asks whether points see the light of whatever lies between, in packets of eight neighbours.
class EmbreePackets {
 public:
  explicit EmbreePackets(const scene::Geometry& geometry) : device_(rtcNewDevice(nullptr)) {
    build_ms = milliseconds([&] {
      scene_ = rtcNewScene(device_);
      RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      void* positions = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                sizeof(glm::vec3), geometry.positions.size());
      std::copy(geometry.positions.begin(), geometry.positions.end(), static_cast<glm::vec3*>(positions));
      void* triangles = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                sizeof(glm::uvec3), geometry.triangles.size());
      std::copy(geometry.triangles.begin(), geometry.triangles.end(), static_cast<glm::uvec3*>(triangles));
      rtcCommitGeometry(mesh);
      rtcAttachGeometry(scene_, mesh);
      rtcReleaseGeometry(mesh);
      rtcCommitScene(scene_);
    });
  }
  ~EmbreePackets() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreePackets(const EmbreePackets&) = delete;
  EmbreePackets& operator=(const EmbreePackets&) = delete;

  /// @param points relative to the light, as of frame::SurfacePoints
  void ask(const std::vector<glm::vec4>& points, glm::vec3 light) const {
    constexpr std::size_t k_packet = 8, k_part = 4096;
    scene::parallel(static_cast<int>((points.size() + k_part - 1) / k_part),
                    [&] {
                      return [&](int part) {
                        RTCIntersectContext context;
                        rtcInitIntersectContext(&context);
                        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
                        const std::size_t first = static_cast<std::size_t>(part) * k_part;
                        for (std::size_t at = first; at < std::min(first + k_part, points.size());
                             at += k_packet) {
                          alignas(32) int valid[k_packet];
                          alignas(32) RTCRay8 rays{};
                          for (std::size_t i = 0; i < k_packet; ++i) {
                            const bool is_asked = at + i < points.size() && points[at + i].w > 0.0f;
                            valid[i] = is_asked ? -1 : 0;
                            if (!is_asked) continue;
                            rays.org_x[i] = light.x;
                            rays.org_y[i] = light.y;
                            rays.org_z[i] = light.z;
                            rays.dir_x[i] = points[at + i].x;
                            rays.dir_y[i] = points[at + i].y;
                            rays.dir_z[i] = points[at + i].z;
                            rays.tfar[i] = 0.9999f;  // before the surface itself
                            rays.mask[i] = ~0u;
                          }
                          rtcOccluded8(valid, scene_, &context, &rays);
                        }
                      };
                    },
                    {});
  }

  double build_ms = 0.0;

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

struct Case {
  scene::Geometry geometry;
  scene::View view;
  surface_shadows::PsvOptions options;
};

glm::vec3 on_circle(double angle, double radius, double z) {
  return glm::vec3(radius * std::cos(angle), radius * std::sin(angle), z);
}

/// A ring of triangles between the light and a wall.
Case strip(int count) {
  Case made;
  for (int i = 0; i < count; ++i) {
    const double step = 2.0 * std::numbers::pi / count, angle = step * i;
    tests::add_triangle(made.geometry, on_circle(angle, 1.0, 2.0), on_circle(angle + 0.8 * step, 1.0, 2.0),
                        on_circle(angle + 0.4 * step, 1.1, 2.0));
  }
  return made;
}

/// Slivers across the way of the light, each through its middle.
Case star(int count) {
  Case made;
  for (int i = 0; i < count; ++i) {
    const double angle = std::numbers::pi * i / count, width = 0.2 * std::numbers::pi / count;
    const double z = 2.0 + 0.5 * i / count;
    tests::add_triangle(made.geometry, on_circle(angle, 1.5, z),
                        on_circle(angle + std::numbers::pi - width, 1.5, z),
                        on_circle(angle + std::numbers::pi + width, 1.5, z));
  }
  return made;
}

/// In front of a wall, seen from beside the light.
void put_before_wall(Case& made) {
  tests::add_quad(made.geometry, {-8, -8, 5}, {16, 0, 0}, {0, 16, 0});
  made.view.camera.eye = {0.0, 0.0, 2.9};
  made.view.camera.target = {0.0, 0.0, 5.0};
  made.view.camera.vertical_fov_degrees = 120.0;
  made.view.lights = {scene::point_light("", {0.003, 0.002, 0.0}, glm::vec3(1e3f))};
}

Case make(const std::string& name, int count) {
  Case made;
  if (name == "spheres") {
    const scene::Scene scene = scene::find_builtin("spheres")->make(static_cast<std::size_t>(count));
    made.geometry = scene.geometry;
    made.view = tests::view_of(scene, {1, 1});
  } else if (name == "strip" || name == "strip-in-order") {
    made = strip(count);
    if (name != "strip") made.options.order = surface_shadows::InsertionOrder::file;
    put_before_wall(made);
  } else if (name == "star") {
    made = star(count);
    put_before_wall(made);
  } else {
    throw std::runtime_error("no case " + name + ": spheres, strip, strip-in-order, star");
  }
  made.view.medium.sigma_s = glm::vec3(1e-9f);
  return made;
}

void draw(frame::Frame& frame, const scene::View& view, frame::SurfaceShadow& method,
          gpu::StageTimer& timer) {
  frame::NoAirlight none;
  frame.render(view, method, none, timer);
}

/// Medians of the stages of a frame by a method [ms].
std::map<std::string, double> stages_of(gpu::Context& context, frame::Frame& frame, const scene::View& view,
                                        frame::SurfaceShadow& method) {
  gpu::StageTimer off(nullptr);
  draw(frame, view, method, off);
  std::map<std::string, std::vector<double>> times;
  for (int i = 0; i < k_repeats; ++i) {
    gpu::StageTimer timer(&context);
    draw(frame, view, method, timer);
    for (const auto& [stage, ms] : timer.milliseconds()) times[stage].push_back(ms);
  }
  std::map<std::string, double> medians;
  for (const auto& [stage, of_stage] : times) medians[stage] = quality::median(of_stage);
  return medians;
}

void run(const std::vector<std::string>& words) {
  int size = 512, cluster = surface_shadows::MetricTreeOptions{}.cluster;
  bool checks = false;
  std::string name;
  std::vector<int> counts;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--size")
      size = std::stoi(words.at(++i));
    else if (words[i] == "--cluster")
      cluster = std::stoi(words.at(++i));
    else if (words[i] == "--check")
      checks = true;
    else if (name.empty())
      name = words[i];
    else
      counts.push_back(std::stoi(words[i]));
  }
  gpu::Context context;
  fmt::print("{:<16} {:>10} {:<12} {:>9} {:>9} {:>7} {:>7} {:>9} {:>12}\n", "case", "triangles", "method",
             "build ms", "query ms", "nodes", "most", "asked", "bytes");
  for (const int count : counts) {
    Case made = make(name, count);
    made.view.size = {size, size};
    frame::Frame frame(context, made.geometry, 2048);
    frame::PointReader reader;
    gpu::StageTimer off(nullptr);
    draw(frame, made.view, reader, off);
    const std::vector<glm::vec4> points = reader.points().of_light.at(0);
    const auto pixels = static_cast<double>(
        std::count_if(points.begin(), points.end(), [](const glm::vec4& point) { return point.w >= 0.0f; }));
    const auto print = [&](const std::string& method, double build, double query, const std::string& rest) {
      fmt::print("{:<16} {:>10} {:<12} {:>9.2f} {:>9.2f} {}\n", name, made.geometry.triangles.size(), method,
                 build, query, rest);
      std::fflush(stdout);
    };

    std::vector<float> expected;
    if (checks) {
      surface_shadows::Brute brute({});
      draw(frame, made.view, brute, off);
      expected = frame.read().visibility.at(0);
    }
    const auto measure_tree = [&](const std::string& method, auto& tree) {
      tree.counts = false;
      const auto stages = stages_of(context, frame, made.view, tree);
      const std::vector<float> answer = frame.read().visibility.at(0);
      if (expected.empty()) expected = answer;
      if (answer != expected) throw std::runtime_error(method + " answers otherwise");
      tree.counts = true;
      draw(frame, made.view, tree, off);
      const auto a_pixel = [&](const char* what) {
        return tree.sums.contains(what) ? tree.sums.at(what) / std::max(pixels, 1.0) : 0.0;
      };
      std::int64_t bytes = 0;
      for (const auto& [what, of_it] : tree.bytes()) bytes += of_it;
      print(method, stages.at("surface_build"), stages.at("surface_query"),
            fmt::format("{:>7.1f} {:>7} {:>9.2f} {:>12}", a_pixel("surface_nodes"),
                        *std::max_element(tree.nodes.begin(), tree.nodes.end()), a_pixel("surface_triangles"),
                        bytes));
    };
    const auto or_limit = [&](const std::string& method, const std::function<void()>& measure) {
      try {
        measure();
      } catch (const scene::Error& limit) {
        fmt::print("{:<16} {:>10} {:<12} {}\n", name, made.geometry.triangles.size(), method, limit.what());
      }
    };
    or_limit("psv", [&] {
      bench::Counted<surface_shadows::Psv> psv(made.options);
      measure_tree("psv", psv);
    });
    or_limit("metric-tree", [&] {
      bench::Counted<surface_shadows::MetricTree> tree(
          surface_shadows::MetricTreeOptions{.cluster = cluster});
      gpu::StageTimer once(&context);
      draw(frame, made.view, tree, once);
      measure_tree("metric-tree", tree);
      print("  clusters", once.milliseconds().at("triangle_clusters"), 0.0,
            fmt::format("{} of {:.2f} triangles, {:.1f} % capsules", tree.cluster_count(),
                        static_cast<double>(made.geometry.triangles.size()) / tree.cluster_count(),
                        100.0 * tree.capsule_share()));
    });

    surface_shadows::ShadowMapLookup shadow_map;
    const auto by_map = stages_of(context, frame, made.view, shadow_map);
    print("shadow-map", by_map.at("shadow_map"), by_map.at("surface_query"), "");

    const EmbreePackets embree(made.geometry);
    const glm::vec3 light(made.view.lights[0].position);
    print("Embree", embree.build_ms, median_ms([&] { embree.ask(points, light); }), "");
  }
}

}  // namespace

int main(int count, char** words) {
  return bench::run_and_report("airlight_exact_growth", run, count, words);
}
