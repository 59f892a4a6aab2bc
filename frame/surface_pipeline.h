#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "frame/scene_buffers.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

namespace airlight::frame {

/// Draws the surfaces of a scene: by one pipeline those of whole triangles, by another, made for the first
/// scene that needs it, what is left of those that are cut out.
class SurfacePipeline {
 public:
  explicit SurfacePipeline(std::function<gpu::Pipeline(bool cut_outs)> make)
      : make_(std::move(make)), whole_(make_(false)) {}

  /// @param may_touch, left_out as of SceneBuffers::draw
  /// @param set_uniforms of either pipeline, before it draws
  void draw(
      const gpu::Framebuffer& target, const SceneBuffers& scene,
      const std::function<bool(const scene::Box&)>& may_touch, std::span<const std::uint32_t> left_out = {},
      const std::function<void(gpu::Pipeline&)>& set_uniforms = [](gpu::Pipeline&) {}) {
    const auto draw_by = [&](gpu::Pipeline& pipeline, Drawn drawn) {
      set_uniforms(pipeline);
      pipeline.draw(target, [&] { scene.draw(may_touch, left_out, drawn); });
    };
    draw_by(whole_, Drawn::whole);
    if (!scene.has_cut_outs()) return;
    if (!cut_outs_) cut_outs_ = make_(true);
    draw_by(*cut_outs_, Drawn::cut_outs);
  }

 private:
  std::function<gpu::Pipeline(bool)> make_;
  gpu::Pipeline whole_;
  std::optional<gpu::Pipeline> cut_outs_;
};

}  // namespace airlight::frame
