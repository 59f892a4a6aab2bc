#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surface_shadows/culled_parts.h"
#include "surface_shadows/occluders.h"
#include "surface_shadows/shadow_tree.h"
#include "surface_shadows/triangle_clusters.h"

namespace airlight::surface_shadows {

enum class Use { on, off };

/// Who makes the tree.
enum class Build {
  gpu,     ///< in each frame, by insertion
  median,  ///< the CPU in each frame, as well as it can: see link_median_tree
};

struct MetricTreeOptions {
  int cluster = 16;             ///< triangles of one at most
  Use capsules = Use::on;       ///< to bound clusters that are long; else spheres alone
  Use slabs = Use::on;          ///< to leave out clusters that the way to the light does not pass through
  Use normal_cones = Use::on;   ///< to leave out clusters of culled triangles alone
  Use distance_cull = Use::on;  ///< of subtrees that lie farther from the light than the point
  Use interval_cull = Use::on;  ///< of overlap subtrees at other distances from their pivot
  Use light_view = Use::on;     ///< to leave out clusters that hide nothing of what the eye may see
  Culling cull = Culling::none;
  Build build = Build::gpu;
  int seed = 1;    ///< of the random order, or of the choices of `median`
  int stack = 32;  ///< nodes that a pixel's stack holds

  bool ignores_cut_outs() const { return true; }
};

/// `metric-tree`: clusters of triangles, made once a scene, in a ternary tree by their distances from each
/// other as the light sees them, which is made anew each frame on the GPU and asked once a pixel. Exact:
/// whatever its other options, it answers what `brute` does with the same culling. Where objects move, each
/// cluster is of one of them, and its bounds go with it.
/// Based on: see shaders/surface_shadows/metric_tree.glsl and triangle_clusters.h.
class MetricTree : public ShadowTree {
 public:
  /// @param limits of its buffers; without, the driver's
  explicit MetricTree(const MetricTreeOptions& options, std::optional<gpu::Limits> limits = {});
  std::map<std::string, std::int64_t> bytes() const override;
  /// "surface_nodes" of the tree that pixels visit, "surface_clusters" and "surface_triangles" that they ask.
  std::map<std::string, double> counters(const frame::FrameInputs& inputs) override;

  void build(const frame::FrameInputs& inputs) override;
  std::vector<gpu::Constant> walk_constants(const frame::SceneBuffers& scene) const override;
  void bind_walk(const frame::FrameInputs& inputs, const gpu::Pipeline& pipeline) const override;

  /// Of the scene that the last `query` was of.
  std::uint32_t cluster_count() const { return cluster_count_; }
  double capsule_share() const { return capsule_share_; }
  /// Clusters that the last `query` asked for every point, because the light is in them or nearly.
  std::uint32_t always_asked() const;

 private:
  /// What rounding and the scene's size make of the light's distances.
  struct Distances {
    float error;          ///< see Observer of shaders/surface_shadows/apparent.glsl
    float slack;          ///< what a decision keeps clear of its limit
    float root_distance;  ///< δ at the root
  };
  static Distances distances(const frame::FrameInputs& inputs, const LightScale& scale);

  TriangleClusters clusters_of(const frame::FrameInputs& inputs,
                               std::span<const std::uint32_t> object_of_triangle) const;
  void load(const frame::FrameInputs& inputs);
  void require_clusters(const frame::FrameInputs& inputs);
  void move_clusters(const scene::Pose& pose) const;
  void link_on_cpu(const frame::FrameInputs& inputs, const Distances& of_light) const;
  void insert_clusters(const frame::FrameInputs& inputs);
  std::uint32_t write_light_view(const frame::FrameInputs& inputs) const;

  MetricTreeOptions options_;
  std::optional<gpu::Limits> limits_;
  gpu::Pipeline cones_program_, insert_program_;

  std::uint64_t scene_ = 0;    ///< SceneBuffers::id
  std::uint64_t at_rest_ = 0;  ///< SceneBuffers::id_at_rest of the scene that the clusters are of, …
  std::shared_ptr<const scene::Objects> objects_;  ///< … and of which objects
  // Where there are any, in the order of the clusters:
  std::vector<TriangleCluster> clusters_at_rest_;
  std::vector<std::uint32_t> object_of_cluster_;  ///< as of Objects::of_triangle
  bool culls_ = false;
  std::uint32_t cluster_count_ = 0;
  double capsule_share_ = 0.0;
  CulledParts culled_parts_;
  LightScale scale_;
  gpu::Buffer clusters_, triangles_, nodes_, always_asked_, light_view_;
  gpu::Buffer partition_distances_;  ///< of Build::median: δ of each node
  gpu::TexelView cluster_texels_, triangle_texels_, node_texels_, always_asked_texels_,
      partition_distance_texels_;
};

frame::SurfaceMethod metric_tree_method();

}  // namespace airlight::surface_shadows
