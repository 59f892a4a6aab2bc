#include "surface_shadows/metric_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "frame/blocks.h"
#include "frame/clusters.h"
#include "surface_shadows/cluster_cache.h"
#include "surface_shadows/median_tree.h"
#include "surface_shadows/transmission.h"
#include "surface_shadows/tree_options.h"

#include "spirv/surface_shadows/metric_tree_cones_comp.h"
#include "spirv/surface_shadows/metric_tree_insert_comp.h"
#include "spirv/surface_shadows/metric_tree_query_frag.h"

namespace airlight::shaders {
#include "surface_shadows/apparent.glsl"
}  // namespace airlight::shaders

namespace airlight::surface_shadows {
namespace {

constexpr std::int64_t k_node_bytes = sizeof(MetricNode);
constexpr std::int64_t k_half_spaces = 32;  ///< more than any light's view has
constexpr const char* k_remedy = "let clusters have more triangles (metric-tree:cluster=N)";

std::uint32_t flag(Use use) {
  return use == Use::on ? 1u : 0u;
}

}  // namespace

std::vector<gpu::Constant> MetricTree::walk_constants(const frame::SceneBuffers& scene) const {
  return {gpu::Constant(31, flag(options_.distance_cull)),
          gpu::Constant(32, static_cast<std::uint32_t>(options_.stack)),
          gpu::Constant(33, flag(options_.interval_cull)),
          gpu::Constant(35, flag(options_.slabs)),
          gpu::Constant(36, options_.build == Build::median ? 1u : 0u),
          transmission_constant(scene)};
}

MetricTree::MetricTree(const MetricTreeOptions& options, std::optional<gpu::Limits> limits)
    : ShadowTree(k_metric_tree_query_frag),
      options_(options),
      limits_(limits),
      insert_program_(gpu::Pipeline::compute(k_metric_tree_insert_comp)) {}

/// As an earlier run has kept them, or made.
TriangleClusters MetricTree::clusters_of(const frame::FrameInputs& inputs,
                                         std::span<const std::uint32_t> object_of_triangle) const {
  const scene::Geometry& geometry = inputs.resources.geometry_at_rest();
  const std::vector<std::uint32_t>&order = inputs.scene.order(), &parts = culled_parts_.of_triangle();
  const ClusterSettings settings = {.most_triangles = static_cast<std::uint32_t>(options_.cluster),
                                    .has_capsules = options_.capsules == Use::on};
  const auto& [cache, tell] = inputs.resources.long_work();
  std::optional<TriangleClusters> clusters;
  std::string key;
  if (!cache.empty()) {
    inputs.timer.time("kept_clusters", [&] {
      key = key_of_clusters(geometry, order, parts, settings, object_of_triangle);
      clusters = load_clusters(cache, key);
    });
    if (clusters) return *std::move(clusters);
  }
  scene::Progress progress;
  if (tell) progress = [&](double fraction) { tell("clusters of triangles", fraction); };
  inputs.timer.time("triangle_clusters", [&] {
    clusters = make_triangle_clusters(geometry, order, parts, settings, object_of_triangle, progress);
  });
  if (!cache.empty()) save_clusters(cache, key, *clusters);
  return *std::move(clusters);
}

void MetricTree::load(const frame::FrameInputs& inputs) {
  objects_ = inputs.view.pose.objects;
  std::vector<std::uint32_t> object_of_triangle;
  if (objects_)
    for (const std::uint32_t triangle : inputs.scene.order())
      object_of_triangle.push_back(objects_->of_triangle[triangle]);
  TriangleClusters made = clusters_of(inputs, object_of_triangle);
  // Their numbers are the order in which they are inserted.
  std::shuffle(made.clusters.begin(), made.clusters.end(),
               std::mt19937(static_cast<std::uint32_t>(options_.seed)));
  cluster_count_ = static_cast<std::uint32_t>(made.clusters.size());
  const auto capsules =
      std::count_if(made.clusters.begin(), made.clusters.end(),
                    [](const TriangleCluster& cluster) { return !cluster.bounds.is_sphere(); });
  capsule_share_ = static_cast<double>(capsules) / std::max(1.0, static_cast<double>(cluster_count_));

  const gpu::Limits& limits = limits_ ? *limits_ : inputs.context.limits();
  const std::int64_t node_bytes = k_node_bytes * (std::int64_t{cluster_count_} + 1);
  gpu::require_storage_block(limits, node_bytes, "the tree of the model's clusters", k_remedy);
  clusters_ = gpu::Buffer::from(std::span<const TriangleCluster>(made.clusters));
  triangles_ = gpu::Buffer::from(std::span<const std::uint32_t>(made.triangles));
  nodes_ = gpu::Buffer(node_bytes);
  always_asked_ = gpu::Buffer(std::int64_t{sizeof(std::uint32_t)} * cluster_count_);
  light_view_ = gpu::Buffer(k_half_spaces * std::int64_t{sizeof(glm::vec4)});
  cluster_texels_ = {limits, clusters_, gpu::Format::rgba32ui, "the model's clusters"};
  triangle_texels_ = {limits, triangles_, gpu::Format::r32ui, "the model's triangles"};
  node_texels_ = {limits, nodes_, gpu::Format::rgba32ui, "the tree of the model's clusters"};
  always_asked_texels_ = {limits, always_asked_, gpu::Format::r32ui, "the model's clusters"};
  if (options_.build == Build::median) {
    partition_distances_ = gpu::Buffer(std::int64_t{sizeof(float)} * (cluster_count_ + 1));
    partition_distance_texels_ = {limits, partition_distances_, gpu::Format::r32f, "the model's clusters"};
  }
  at_rest_ = inputs.scene.id_at_rest();

  clusters_at_rest_.clear();
  object_of_cluster_.clear();
  if (!objects_) return;
  for (const TriangleCluster& cluster : made.clusters)
    object_of_cluster_.push_back(object_of_triangle[made.triangles[cluster.first]]);
  clusters_at_rest_ = std::move(made.clusters);
}

void MetricTree::move_clusters(const scene::Pose& pose) const {
  std::vector<TriangleCluster> clusters = clusters_at_rest_;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const std::uint32_t object = object_of_cluster_[i];
    if (object != 0 && !pose.motions[object - 1].is_identity())
      clusters[i].bounds = moved(clusters[i].bounds, pose.motions[object - 1]);
  }
  clusters_.write(clusters.data(), clusters_.bytes());
}

/// Clusters, where the view has their triangles.
void MetricTree::require_clusters(const frame::FrameInputs& inputs) {
  const scene::Pose& pose = inputs.view.pose;
  bool are_there = at_rest_ == inputs.scene.id_at_rest() && objects_ == pose.objects;
  if (are_there && scene_ == inputs.scene.id()) return;
  const bool is_first = scene_ == 0, culled = std::exchange(culls_, culls(options_.cull, inputs.scene));
  if (is_first || culled != culls_) {
    culled_parts_ = {};
    cones_program_ = gpu::Pipeline::compute(
        k_metric_tree_cones_comp,
        std::array{gpu::Constant(0, culls_ ? 1u : 0u), gpu::Constant(1, flag(options_.normal_cones))});
  }
  if (culls_) {
    // What touches is one part: where objects come together or part, other triangles are.
    CulledParts parts(inputs);
    are_there = are_there && parts.of_triangle() == culled_parts_.of_triangle();
    culled_parts_ = std::move(parts);
  }
  if (!are_there) load(inputs);
  if (objects_ && cluster_count_ > 0) inputs.timer.time("surface_build", [&] { move_clusters(pose); });
  scene_ = inputs.scene.id();
}

MetricTree::Distances MetricTree::distances(const frame::FrameInputs& inputs, const LightScale& scale) {
  const scene::Box& box = inputs.scene.box();
  const glm::dvec3 middle = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper));
  const double radius = glm::distance(middle, glm::dvec3(box.upper));
  Distances result;
  if (scene::is_sun(inputs.light())) {
    result.error = shaders::k_foot_error * scale.reach;
    result.root_distance = scale.scale * static_cast<float>(radius);
  } else {
    const double distance = glm::distance(middle, inputs.light().position);
    result.error = shaders::k_angle_error;
    result.root_distance =
        static_cast<float>(distance > radius ? std::asin(radius / distance) : std::numbers::pi);
  }
  result.slack = shaders::k_decisions * result.error;
  return result;
}

std::uint32_t MetricTree::write_light_view(const frame::FrameInputs& inputs) const {
  if (options_.light_view == Use::off) return 0;
  const scene::Light& light = inputs.light();
  const scene::CameraFrame camera = scene::camera_frame(inputs.view.camera, inputs.view.size);
  std::vector<glm::dvec3> seen;
  for (const glm::dvec3& ray : scene::corner_rays(camera)) seen.push_back(glm::normalize(ray));
  // Points that a frame shades lie in its triangles, and may lie 2⁻¹⁶ of a triangle's size out of view.
  const double margin = 1e-4 * static_cast<double>(scale_.reach);
  constexpr double k_rounding = 1e-12;
  std::vector<glm::vec4> half_spaces;
  const auto add = [&](glm::dvec3 inward, double offset) {
    half_spaces.emplace_back(glm::vec3(inward), static_cast<float>(offset + margin));
  };

  // From a lamp what lies between it and the view is seen along sums of the way to the eye and view rays;
  // from a point of the view a sun is along sums of view rays and the way to it.
  const bool is_sun = scene::is_sun(light);
  const glm::dvec3 to_eye = camera.eye - light.position;
  std::vector<glm::dvec3> between = seen;
  between.push_back(is_sun ? light.towards : glm::normalize(to_eye));
  for (const glm::dvec3& side : frame::sides_of_cone(between, k_rounding)) add(side, 0.0);
  // A side of the view that has the lamp inside, too, has all that lies between.
  if (!is_sun) {
    for (const glm::dvec3& side : frame::sides_of_cone(seen, k_rounding)) {
      const double offset = -static_cast<double>(scale_.scale) * glm::dot(side, to_eye);
      if (offset >= 0.0) add(side, offset);
    }
  }
  if (half_spaces.size() > static_cast<std::size_t>(k_half_spaces)) half_spaces.resize(k_half_spaces);
  light_view_.write(half_spaces.data(), static_cast<std::int64_t>(half_spaces.size() * sizeof(glm::vec4)));
  return static_cast<std::uint32_t>(half_spaces.size());
}

void MetricTree::build(const frame::FrameInputs& inputs) {
  inputs.triangle_planes();  // a stage of its own
  require_clusters(inputs);
  inputs.timer.time("surface_build", [&] { insert_clusters(inputs); });
}

void MetricTree::insert_clusters(const frame::FrameInputs& inputs) {
  scale_ = light_scale(inputs);
  // Before the first node stands what leads to it.
  constexpr std::array<std::uint32_t, k_node_bytes / sizeof(std::uint32_t)> k_no_tree{};
  nodes_.write(k_no_tree.data(), k_node_bytes);
  if (cluster_count_ == 0) return;
  if (culls_) {
    culled_parts_.find(inputs, scale_.margin());
    culled_parts_.bind();
  }
  const frame::LightOrigin origin = inputs.resources.origin();
  const Distances of_light = distances(inputs, scale_);
  cluster_texels_.bind_sampler(shaders::k_clusters_unit);
  nodes_.bind_storage(shaders::k_metric_tree_storage);
  always_asked_.bind_storage(shaders::k_always_asked_storage);
  light_view_.bind_storage(shaders::k_light_view_storage);
  cones_program_.set(0, origin.high);
  cones_program_.set(1, origin.low);
  cones_program_.set(2, scale_.scale);
  cones_program_.set(3, cluster_count_);
  cones_program_.set(4, write_light_view(inputs));
  cones_program_.dispatch({cluster_count_, 1, 1});

  if (options_.build == Build::median) return link_on_cpu(inputs, of_light);
  insert_program_.set(0, cluster_count_);
  insert_program_.set(1, of_light.error);
  insert_program_.set(2, of_light.root_distance);
  insert_program_.set(3, of_light.slack);
  insert_program_.dispatch({cluster_count_, 1, 1});
}

void MetricTree::link_on_cpu(const frame::FrameInputs& inputs, const Distances& of_light) const {
  std::vector<MetricNode> nodes = nodes_.read<MetricNode>();
  const scene::Light& light = inputs.light();
  const std::vector<float> distances = link_median_tree(nodes,
                                                        {.travels = -glm::vec3(light.towards),
                                                         .is_sun = scene::is_sun(light),
                                                         .error = of_light.error,
                                                         .slack = of_light.slack},
                                                        static_cast<std::uint32_t>(options_.seed));
  nodes_.write(nodes.data(), nodes_.bytes());
  partition_distances_.write(distances.data(), partition_distances_.bytes());
}

void MetricTree::bind_walk(const frame::FrameInputs& inputs, const gpu::Pipeline& pipeline) const {
  inputs.scene.bind_samplers();
  inputs.triangle_planes().bind_sampler(shaders::k_triangle_planes_unit);
  if (inputs.scene.transmits()) inputs.scene.attenuations().bind_sampler(shaders::k_attenuations_unit);
  cluster_texels_.bind_sampler(shaders::k_clusters_unit);
  triangle_texels_.bind_sampler(shaders::k_cluster_triangles_unit);
  always_asked_texels_.bind_sampler(shaders::k_always_asked_unit);
  node_texels_.bind_sampler(shaders::k_metric_tree_unit);
  if (options_.build == Build::median)
    partition_distance_texels_.bind_sampler(shaders::k_partition_distances_unit);
  const frame::LightOrigin origin = inputs.resources.origin();
  const Distances of_light = distances(inputs, scale_);
  pipeline.set(1, scale_.scale);
  pipeline.set(2, origin.high);
  pipeline.set(3, origin.low);
  pipeline.set(4, of_light.error);
  pipeline.set(5, of_light.slack);
  // Without these the shader has no use for it, and no place.
  if (options_.build == Build::gpu) pipeline.set(6, of_light.root_distance);
  if (options_.slabs == Use::on || options_.distance_cull == Use::on) pipeline.set(7, scale_.reach);
}

std::uint32_t MetricTree::always_asked() const {
  constexpr std::int64_t k_word = 11;  // MetricNode::place of node 0
  return nodes_.read<std::uint32_t>(k_word, 1).at(0);
}

std::map<std::string, double> MetricTree::counters(const frame::FrameInputs& inputs) {
  return {{"surface_nodes", total(inputs, Counted::nodes)},
          {"surface_clusters", total(inputs, Counted::clusters)},
          {"surface_triangles", total(inputs, Counted::triangles)}};
}

std::map<std::string, std::int64_t> MetricTree::bytes() const {
  return {{"clusters", clusters_.bytes() + triangles_.bytes()},
          {"tree", nodes_.bytes() + partition_distances_.bytes() + always_asked_.bytes() +
                       light_view_.bytes() + culled_parts_.bytes()}};
}

frame::SurfaceMethod metric_tree_method() {
  using Options = MetricTreeOptions;
  const auto use_option = [](std::string_view name, std::string_view meaning, std::string_view cost,
                             Use Options::*field) {
    return frame::word_option<Options, Use>(
        {.name = name, .meaning = meaning, .quality = "none", .cost = cost, .sweep = {"on", "off"}},
        {{"on"}, {"off"}}, field);
  };
  return frame::describe<frame::SurfaceShadow, Options>(
      "metric-tree", "clusters of triangles in a ternary metric tree of what the light sees of them, exact",
      {.is_exact = true, .transmits = true},
      {frame::count_option<Options>({.name = "cluster",
                                     .meaning = "triangles of a cluster at most",
                                     .quality = "none",
                                     .cost = "more triangles asked for a smaller tree",
                                     .sweep = {"8", "16", "32"}},
                                    {.least = 1, .most = static_cast<int>(k_part_unit) - 1},
                                    &Options::cluster),
       use_option("capsules", "whether long clusters are bounded by capsules, not by spheres",
                  "off visits more nodes where triangles are long", &Options::capsules),
       use_option("slabs", "whether clusters are left out whose slabs the way to the light misses",
                  "off asks more triangles", &Options::slabs),
       use_option("normal-cones",
                  "whether clusters of which all triangles are culled are left out of the tree",
                  "off has a larger tree with cull=auto", &Options::normal_cones),
       use_option("distance-cull", "whether subtrees are left out that lie beyond the point",
                  "off visits more nodes", &Options::distance_cull),
       use_option("interval-cull",
                  "whether what overlaps a node's limit is left out where the point's distance is another",
                  "off visits more nodes", &Options::interval_cull),
       use_option("light-view", "whether clusters are left out of the tree that hide nothing in view",
                  "off has a larger tree", &Options::light_view),
       culling_option(&Options::cull),
       frame::word_option<Options, Build>(
           {.name = "build",
            .meaning = "who makes the tree",
            .quality = "none",
            .cost = "median visits fewer nodes of a tree that takes the CPU long",
            .sweep = {"gpu", "median"}},
           {{"gpu", "the GPU, by insertion"},
            {"median", "the CPU, with medians and pivots chosen among many"}},
           &Options::build),
       seed_option(&Options::seed), stack_option(&Options::stack)},
      [](const gpu::Context&, const Options& options) { return std::make_unique<MetricTree>(options); });
}

}  // namespace airlight::surface_shadows
