// Exact surface shadows on models under random lights and views: wrong and undecided pixels, nodes a pixel.
//
// `airlight_exact [--size N] [--scale S] [--offset X] [--factors|--clusters] MODEL...`: built-in scenes or
// files. Of each, ten views of N×N pixels (default 1024), from inside and outside, under lamps inside,
// outside, close to the ground and far away and under suns, the same ones in every run. Positions are scaled
// by S and moved by X sizes of the model, and rounded to float. Every pixel is judged
// (reference/surface_judge.h): of `psv`, of `metric-tree`, which has to answer the same, and of the shadow
// cube of 2048².
//
// `--factors` instead: nodes a pixel of the same views, of both trees as their papers have them (triangles
// that face the light left out where that is right), and by how much they grow with one of their means taken
// away; of metric-tree clusters and triangles asked, too. All settings have to give the same image, but for
// culling, whose pixels are judged.
//
// `--clusters` instead: of metric-tree how many triangles its clusters have, how many are capsules, the bytes
// of clusters and tree and the time of grouping; and of the same views how much longer its queries take, and
// how many more nodes they visit, than of the tree with medians that the CPU makes.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "counted.h"
#include "frame/frame.h"
#include "frame/none.h"
#include "frame/point_reader.h"
#include "gpu/context.h"
#include "quality/metrics.h"
#include "quality/statistics.h"
#include "quality/traced.h"
#include "report.h"
#include "scene/builtin.h"
#include "scene/import.h"
#include "support/random.h"
#include "surface_shadows/metric_tree.h"
#include "surface_shadows/psv.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace {

using namespace airlight;

using surface_shadows::MetricTree, surface_shadows::MetricTreeOptions, surface_shadows::Psv,
    surface_shadows::PsvOptions;

struct Row {
  std::size_t pixels = 0, wrong = 0, wrong_by_map = 0, undecided = 0;
  std::size_t other_by_clusters = 0;  ///< pixels of which metric-tree says otherwise than psv
  double nodes = 0.0, nodes_of_clusters = 0.0;
  float most_nodes = 0.0f, most_nodes_of_clusters = 0.0f;
};

scene::View view_number(int i, const scene::Box& box, int size, tests::Random& random) {
  const glm::dvec3 lower(box.lower), extent = glm::dvec3(box.upper) - lower, middle = lower + 0.5 * extent;
  const double radius = 0.5 * glm::length(extent);
  const auto inside = [&](double least_y, double most_y) {
    return lower + extent * glm::dvec3(random.uniform(0.05, 0.95), random.uniform(least_y, most_y),
                                       random.uniform(0.05, 0.95));
  };
  const auto above = [&] {
    glm::dvec3 direction = random.direction();
    direction.y = std::abs(direction.y);
    return direction;
  };
  scene::View view;
  view.size = {size, size};
  view.medium.sigma_s = glm::vec3(static_cast<float>(1e-9 / radius));
  view.camera.eye = i < 5 ? middle + random.uniform(0.8, 1.6) * radius * above() : inside(0.1, 0.9);
  view.camera.target = i < 5 ? middle : inside(0.1, 0.9);
  view.camera.vertical_fov_degrees = 60.0;
  const auto lamp = [&](glm::dvec3 at) {
    const double distance = glm::distance(at, middle) + radius;
    return scene::point_light("", at, glm::vec3(static_cast<float>(1e6 * distance * distance)));
  };
  switch (i % 5) {
    case 0:
      view.lights = {lamp(inside(0.2, 0.9))};
      break;
    case 1:
      view.lights = {lamp(middle + random.uniform(1.5, 3.0) * radius * above())};
      break;
    case 2: {
      glm::dvec3 at = middle + 1.3 * radius * random.direction();
      at.y = lower.y + 0.01 * extent.y + 1e-3 * radius;
      view.lights = {lamp(at)};
      break;
    }
    case 3:
      view.lights = {lamp(middle + 100.0 * radius * above())};
      break;
    default:
      view.lights = {scene::sun("", above(), glm::vec3(1.0f))};
  }
  return view;
}

std::vector<float> visibility_by(frame::Frame& frame, const scene::View& view, frame::SurfaceShadow& method) {
  frame::NoAirlight none;
  gpu::StageTimer timer(nullptr);
  frame.render(view, method, none, timer);
  return frame.read().visibility.at(0);
}

Row measure(gpu::Context& context, const scene::Geometry& geometry, int size) {
  Row row;
  const scene::Box box = scene::bounds(geometry);
  frame::Frame frame(context, geometry, 2048);
  bench::Counted<Psv> psv(PsvOptions{});
  bench::Counted<MetricTree> tree(MetricTreeOptions{});
  surface_shadows::ShadowMapLookup shadow_map;
  tests::Random random(2015);
  for (int i = 0; i < 10; ++i) {
    const scene::View view = view_number(i, box, size, random);
    frame::PointReader reader;
    visibility_by(frame, view, reader);
    const std::vector<float> exact = visibility_by(frame, view, psv),
                             by_clusters = visibility_by(frame, view, tree),
                             by_map = visibility_by(frame, view, shadow_map);
    quality::SharedReference reference(geometry, view, {});
    const quality::SurfaceVerdicts& verdicts = reference.verdicts(0, reader.points());
    const quality::SurfaceError error = quality::surface_error(exact, verdicts);
    row.pixels += error.pixels;
    row.wrong += error.wrong_pixels;
    row.undecided += error.undecided_pixels;
    row.wrong_by_map += quality::surface_error(by_map, verdicts).wrong_pixels;
    for (std::size_t pixel = 0; pixel < exact.size(); ++pixel) {
      if (!verdicts[pixel]) continue;
      row.nodes += static_cast<double>(psv.nodes[pixel]);
      row.most_nodes = std::max(row.most_nodes, psv.nodes[pixel]);
      row.nodes_of_clusters += static_cast<double>(tree.nodes[pixel]);
      row.most_nodes_of_clusters = std::max(row.most_nodes_of_clusters, tree.nodes[pixel]);
      if (by_clusters[pixel] != exact[pixel]) ++row.other_by_clusters;
      if (quality::is_wrong(exact[pixel], *verdicts[pixel]))
        fmt::print(stderr, "view {}, pixel {} is {}\n", i, pixel, exact[pixel]);
    }
  }
  row.nodes /= static_cast<double>(std::max<std::size_t>(row.pixels, 1));
  row.nodes_of_clusters /= static_cast<double>(std::max<std::size_t>(row.pixels, 1));
  return row;
}

template <class Options>
struct Setting {
  std::string name;
  Options options;
};

/// Of settings of one tree: the first is its paper's, with culling, the others are without.
template <class Tree, class Options>
void print_factors(gpu::Context& context, const scene::Geometry& geometry, int size, const std::string& tree,
                   const std::vector<Setting<Options>>& settings) {
  const scene::Box box = scene::bounds(geometry);
  frame::Frame frame(context, geometry, 16);
  std::vector<double> nodes(settings.size());
  std::vector<float> most(settings.size());
  std::vector<std::map<std::string, double>> asked(settings.size());
  std::size_t pixels = 0, wrong_by_culling = 0, changed_by_culling = 0, seeds_that_differ = 0;
  tests::Random random(2015);
  for (int i = 0; i < 10; ++i) {
    const scene::View view = view_number(i, box, size, random);
    frame::PointReader reader;
    visibility_by(frame, view, reader);
    const std::vector<glm::vec4>& points = reader.points().of_light.at(0);
    std::vector<std::vector<float>> answers;
    for (std::size_t k = 0; k < settings.size(); ++k) {
      bench::Counted<Tree> counted(settings[k].options);
      answers.push_back(visibility_by(frame, view, counted));
      for (const auto& [what, count] : counted.sums) asked[k][what] += count;
      for (std::size_t pixel = 0; pixel < points.size(); ++pixel) {
        if (points[pixel].w < 0.0f) continue;
        nodes[k] += static_cast<double>(counted.nodes[pixel]);
        most[k] = std::max(most[k], counted.nodes[pixel]);
        if (k == 0) ++pixels;
      }
      if (k > 1 && answers[k] != answers[1])
        fmt::print(stderr, "view {}, {}: not the same\n", i, settings[k].name);
    }
    Options other_seed;
    other_seed.seed = 2 + i;
    Tree of_other_seed(other_seed);
    if (visibility_by(frame, view, of_other_seed) != answers[1]) ++seeds_that_differ;
    quality::SharedReference reference(geometry, view, {});
    wrong_by_culling +=
        quality::surface_error(answers[0], reference.verdicts(0, reader.points())).wrong_pixels;
    for (std::size_t pixel = 0; pixel < points.size(); ++pixel)
      if (points[pixel].w >= 0.0f && answers[0][pixel] != answers[1][pixel]) ++changed_by_culling;
  }
  fmt::print("  {}: {} pixels; culling changes {} of them and has {} wrong; {} of ten seeds differ\n", tree,
             pixels, changed_by_culling, wrong_by_culling, seeds_that_differ);
  for (std::size_t k = 0; k < settings.size(); ++k) {
    fmt::print("    {:<24} {:>9.1f} nodes, {:>8} at most, x {:.2f}", settings[k].name,
               nodes[k] / static_cast<double>(pixels), most[k], nodes[k] / nodes[0]);
    for (const char* what : {"surface_clusters", "surface_triangles"})
      if (asked[k].contains(what))
        fmt::print(", {} {:.2f}", what, asked[k].at(what) / static_cast<double>(pixels));
    fmt::print("\n");
  }
  std::fflush(stdout);
}

void print_factors(gpu::Context& context, const std::string& name, const scene::Geometry& geometry,
                   int size) {
  using surface_shadows::Culling, surface_shadows::Wedge, surface_shadows::InsertionOrder,
      surface_shadows::Traversal, surface_shadows::Use;
  fmt::print("{}: {} triangles\n", name, geometry.triangles.size());
  print_factors<Psv, PsvOptions>(context, geometry, size, "psv",
                                 {{"paper's", {.cull = Culling::automatic}},
                                  {"cull=none", {}},
                                  {"cull=none, stackless", {.traversal = Traversal::stackless}},
                                  {"cull=none, file", {.order = InsertionOrder::file}},
                                  {"cull=none, no wedge", {.wedge = Wedge::off, .stack = 128}}});
  print_factors<MetricTree, MetricTreeOptions>(
      context, geometry, size, "metric-tree",
      {{"paper's", {.cull = Culling::automatic}},
       {"cull=none", {}},
       {"cull=none, spheres", {.capsules = Use::off}},
       {"cull=none, no slabs", {.slabs = Use::off}},
       {"cull=none, no distances", {.distance_cull = Use::off}},
       {"cull=none, no intervals", {.interval_cull = Use::off}},
       {"cull=none, all of space", {.light_view = Use::off}},
       {"cull=none, medians", {.build = surface_shadows::Build::median}},
       {"cull=none, cluster=8", {.cluster = 8}},
       {"cull=none, cluster=32", {.cluster = 32}}});
}

/// The median time of queries of a tree, each frame but the first [ms].
double query_ms(gpu::Context& context, frame::Frame& frame, const scene::View& view, MetricTree& tree,
                double& grouping_ms) {
  std::vector<double> times;
  for (int i = 0; i < 6; ++i) {
    frame::NoAirlight none;
    gpu::StageTimer timer(&context);
    frame.render(view, tree, none, timer);
    const std::map<std::string, double> stages = timer.milliseconds();
    if (stages.contains("triangle_clusters")) grouping_ms = stages.at("triangle_clusters");
    if (i > 0) times.push_back(stages.at("surface_query"));
  }
  return quality::median(times);
}

void print_clusters(gpu::Context& context, const std::string& name, const scene::Geometry& geometry,
                    int size) {
  const scene::Box box = scene::bounds(geometry);
  frame::Frame frame(context, geometry, 16);
  MetricTree tree({}), medians({.build = surface_shadows::Build::median});
  bench::Counted<MetricTree> counted_tree(MetricTreeOptions{}),
      counted_medians(MetricTreeOptions{.build = surface_shadows::Build::median});
  tests::Random random(2015);
  double grouping_ms = 0.0, worst_time = 1e30, all_times = 0.0, all_median_times = 0.0;
  double worst_nodes = 1e30, all_nodes = 0.0, all_median_nodes = 0.0;
  for (int i = 0; i < 10; ++i) {
    const scene::View view = view_number(i, box, size, random);
    const double median_ms = query_ms(context, frame, view, medians, grouping_ms),
                 ms = query_ms(context, frame, view, tree, grouping_ms);
    if (visibility_by(frame, view, counted_tree) != visibility_by(frame, view, counted_medians))
      fmt::print(stderr, "view {}: not the same\n", i);
    const double nodes = counted_tree.sums.at("surface_nodes"),
                 median_nodes = counted_medians.sums.at("surface_nodes");
    worst_time = std::min(worst_time, median_ms / ms);
    worst_nodes = std::min(worst_nodes, median_nodes / nodes);
    all_times += ms;
    all_median_times += median_ms;
    all_nodes += nodes;
    all_median_nodes += median_nodes;
  }
  const std::map<std::string, std::int64_t> bytes = tree.bytes();
  fmt::print(
      "{}: {} triangles, {} clusters of {:.2f}, {:.1f} % capsules, {:.1f} MB, grouped in {:.0f} ms\n"
      "  medians: {:.1f} % of the time of queries, of the worst view {:.1f} %; of the nodes {:.1f} %, {:.1f} "
      "%\n",
      name, geometry.triangles.size(), tree.cluster_count(),
      static_cast<double>(geometry.triangles.size()) / std::max(1u, tree.cluster_count()),
      100.0 * tree.capsule_share(), 1e-6 * static_cast<double>(bytes.at("clusters") + bytes.at("tree")),
      grouping_ms, 100.0 * all_median_times / all_times, 100.0 * worst_time,
      100.0 * all_median_nodes / all_nodes, 100.0 * worst_nodes);
}

scene::Geometry load(const std::string& name) {
  if (const scene::BuiltinScene* builtin = scene::find_builtin(name)) return builtin->make().geometry;
  return scene::import_scene(name).geometry;
}

void run(const std::vector<std::string>& words) {
  int size = 1024;
  double scale = 1.0, offset = 0.0;
  bool prints_factors = false, prints_clusters = false;
  std::vector<std::string> models;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--factors")
      prints_factors = true;
    else if (words[i] == "--clusters")
      prints_clusters = true;
    else if (words[i] == "--size")
      size = std::stoi(words.at(++i));
    else if (words[i] == "--scale")
      scale = std::stod(words.at(++i));
    else if (words[i] == "--offset")
      offset = std::stod(words.at(++i));
    else
      models.push_back(words[i]);
  }
  gpu::Context context;
  if (!prints_factors && !prints_clusters)
    fmt::print("{:<32} {:>10} {:>10} {:>8} {:>8} {:>10} {:>10} {:>8} {:>8} {:>10} {:>8}\n", "model",
               "triangles", "pixels", "wrong", "differ", "undecided", "map wrong", "psv", "most",
               "metric tree", "most");
  for (const std::string& model : models) {
    scene::Geometry geometry = load(model);
    const scene::Box box = scene::bounds(geometry);
    const double moved = offset * static_cast<double>(glm::length(box.upper - box.lower));
    for (glm::vec3& position : geometry.positions)
      position = glm::vec3(scale * (glm::dvec3(position) + moved));
    const std::string name = model.substr(model.rfind('/') + 1);
    if (prints_factors) {
      print_factors(context, name, geometry, size);
      std::fflush(stdout);
      continue;
    }
    if (prints_clusters) {
      print_clusters(context, name, geometry, size);
      std::fflush(stdout);
      continue;
    }
    const Row row = measure(context, geometry, size);
    fmt::print("{:<32} {:>10} {:>10} {:>8} {:>8} {:>10} {:>10} {:>8.1f} {:>8} {:>10.1f} {:>8}\n", name,
               geometry.triangles.size(), row.pixels, row.wrong, row.other_by_clusters, row.undecided,
               row.wrong_by_map, row.nodes, row.most_nodes, row.nodes_of_clusters,
               row.most_nodes_of_clusters);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** words) {
  return bench::run_and_report("airlight_exact", run, count, words);
}
