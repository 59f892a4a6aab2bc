#include "frame/gbuffer.h"

#include <array>

#include "frame/blocks.h"
#include "frame/reversed_depth.h"

#include "spirv/frame/gbuffer_frag.h"
#include "spirv/frame/gbuffer_vert.h"
#include "spirv/frame/surfaces_frag.h"

namespace airlight::frame {

GBuffer::GBuffer(glm::ivec2 size)
    : triangles_(gpu::Format::r32ui, size),
      surfaces_(gpu::Format::rgba32f, size),
      depth_(gpu::Format::depth32f, size),
      framebuffer_({triangles_}, depth_),
      draw_([](bool cut_outs) {
        return gpu::Pipeline::graphics({.vertex = k_gbuffer_vert, .fragment = k_gbuffer_frag},
                                       k_reversed_depth, std::array{gpu::Constant(0, cut_outs)});
      }),
      resolve_(k_surfaces_frag) {}

void GBuffer::draw(const SceneBuffers& scene, const scene::CameraFrame& camera,
                   std::span<const std::uint32_t> left_out) {
  framebuffer_.clear();
  const Pyramid seen{.apex = camera.eye,
                     .right = camera.right,
                     .up = camera.up,
                     .forward = camera.forward,
                     .half_width = camera.half_width,
                     .half_height = camera.half_height};
  draw_.draw(
      framebuffer_, scene, [&](const scene::Box& box) { return may_touch(seen, box); }, left_out);
  find_surfaces(scene, surfaces_);
}

void GBuffer::find_surfaces(const SceneBuffers& scene, const gpu::Texture& surfaces) const {
  scene.bind_samplers();
  triangles_.bind_sampler(shaders::k_triangle_unit);
  resolve_.run({surfaces});
}

}  // namespace airlight::frame
