#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "frame/method.h"
#include "frame/screen_pass.h"

namespace airlight::surface_shadows {

/// A tree that is made anew for each light and tells of any point which triangles may lie between it and the
/// light. Pixels ask it for the points that they shade; other shaders may ask it, too, for any (light_at of
/// shaders/surface_shadows/psv_walk.glsl and metric_tree_walk.glsl).
class ShadowTree : public frame::SurfaceShadow {
 public:
  gpu::Format visibility_format(const frame::SceneBuffers& scene) const override;
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override;

  /// How many nodes each pixel visited, instead of visibility, of the tree that the last `query` made.
  /// @param counts r32f
  void count_nodes(const frame::FrameInputs& inputs, const gpu::Texture& counts);

  /// Makes the tree for the light of `inputs`.
  /// @throws scene::Error (driver) for a tree that is larger than one storage block
  virtual void build(const frame::FrameInputs& inputs) = 0;

  // Of shaders that go down the tree:
  virtual std::vector<gpu::Constant> walk_constants(const frame::SceneBuffers& scene) const = 0;
  /// @param inputs as of `build`
  virtual void bind_walk(const frame::FrameInputs& inputs, const gpu::Pipeline& pipeline) const = 0;

 protected:
  /// @param query the shader of a pixel; its constant 0 is a Counted that it knows
  explicit ShadowTree(std::span<const std::uint32_t> query) : query_(query) {}

  /// What a pixel writes in the place of visibility.
  enum class Counted : std::uint32_t { none, nodes, clusters, triangles };

  /// Of the tree that the last `query` made, over all pixels.
  double total(const frame::FrameInputs& inputs, Counted counted);

 private:
  const frame::ScreenPass& pass(const frame::SceneBuffers& scene, Counted counted);
  void run(const frame::ScreenPass& pass, const frame::FrameInputs& inputs, const gpu::Texture& image) const;

  std::span<const std::uint32_t> query_;
  std::map<std::pair<bool, Counted>, frame::ScreenPass> passes_;  ///< by whether the scene transmits
};

}  // namespace airlight::surface_shadows
