#pragma once

#include <optional>
#include <vector>

#include "frame/method.h"
#include "frame/screen_pass.h"
#include "surface_shadows/occluders.h"
#include "surface_shadows/transmission.h"

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
class Psv : public frame::SurfaceShadow {
 public:
  explicit Psv(const PsvOptions& options);
  gpu::Format visibility_format(const frame::SceneBuffers& scene) const override {
    return transmission_format(scene);
  }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override;
  std::map<std::string, std::int64_t> bytes() const override;
  /// "surface_nodes" of the tree that pixels visit.
  std::map<std::string, double> counters(const frame::FrameInputs& inputs) override;

  /// How many nodes each pixel visited, instead of visibility, of the tree that the last `query` made.
  /// @param counts r32f
  void count_nodes(const frame::FrameInputs& inputs, const gpu::Texture& counts);

  /// Makes the tree for the light of `inputs`.
  void build(const frame::FrameInputs& inputs);

  // Of shaders that go down the tree (shaders/surface_shadows/psv_walk.glsl):
  std::vector<gpu::Constant> walk_constants(const frame::SceneBuffers& scene) const;
  /// @param inputs as of `build`
  void bind_walk(const frame::FrameInputs& inputs, const gpu::Pipeline& pipeline) const;

 private:
  void load(const frame::FrameInputs& inputs);
  void run(const frame::ScreenPass& pass, const frame::FrameInputs& inputs, const gpu::Texture& image) const;
  frame::ScreenPass query_pass(const frame::SceneBuffers& scene, bool counts) const;

  PsvOptions options_;
  Occluders occluders_;
  gpu::Pipeline planes_program_, insert_program_;
  std::optional<frame::ScreenPass> query_;  ///< of the scene
  bool transmits_ = false;
  std::uint64_t scene_ = 0;  ///< SceneBuffers::id
  gpu::Buffer order_, planes_, links_, subtrees_;
  gpu::TexelView order_texels_, plane_texels_, link_texels_, subtree_texels_;
};

frame::SurfaceMethod psv_method();

}  // namespace airlight::surface_shadows
