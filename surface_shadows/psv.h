#pragma once

#include <vector>

#include "surface_shadows/occluders.h"
#include "surface_shadows/shadow_tree.h"

namespace airlight::surface_shadows {

enum class InsertionOrder { random, file };
enum class Wedge { on, off };
enum class Traversal {
  stack,      ///< what is left to visit is kept on a stack; where it overflows, the point starts anew without
  stackless,  ///< each node is decided anew on the way back
};

struct PsvOptions {
  Culling cull = Culling::none;
  Wedge wedge = Wedge::on;
  InsertionOrder order = InsertionOrder::random;
  int seed = 1;  ///< of the random order
  Traversal traversal = Traversal::stack;
  int stack = 32;  ///< nodes that a pixel's stack holds

  bool ignores_cut_outs() const { return true; }
};

/// `psv`: partitioned shadow volumes, a ternary tree over the triangles' shadow volumes that is made anew
/// each frame on the GPU and asked once a pixel. Exact: whatever its other options, it answers what `brute`
/// does with the same culling.
/// Based on: see shaders/surface_shadows/top_tree.glsl.
class Psv : public ShadowTree {
 public:
  explicit Psv(const PsvOptions& options);
  std::map<std::string, std::int64_t> bytes() const override;
  /// "surface_nodes" of the tree that pixels visit.
  std::map<std::string, double> counters(const frame::FrameInputs& inputs) override;

  void build(const frame::FrameInputs& inputs) override;
  std::vector<gpu::Constant> walk_constants(const frame::SceneBuffers& scene) const override;
  void bind_walk(const frame::FrameInputs& inputs, const gpu::Pipeline& pipeline) const override;

 private:
  void load(const frame::FrameInputs& inputs);

  PsvOptions options_;
  Occluders occluders_;
  gpu::Pipeline planes_program_, insert_program_;
  std::uint64_t scene_ = 0;  ///< SceneBuffers::id
  gpu::Buffer order_, planes_, links_, subtrees_;
  gpu::TexelView order_texels_, plane_texels_, link_texels_, subtree_texels_;
};

frame::SurfaceMethod psv_method();

}  // namespace airlight::surface_shadows
