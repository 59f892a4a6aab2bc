#include "frame/screen_pass.h"

#include <epoxy/gl.h>

#include "spirv/frame/listed_rays_vert.h"
#include "spirv/frame/screen_vert.h"

namespace airlight::frame {

ScreenPass::ScreenPass(std::span<const std::uint32_t> fragment, std::span<const gpu::Constant> constants,
                       gpu::Blend blend, Texels texels)
    : texels_(texels),
      pipeline_(gpu::Pipeline::graphics(
          {.vertex =
               texels == Texels::all ? std::span<const std::uint32_t>(k_screen_vert) : k_listed_rays_vert,
           .fragment = fragment},
          {.depth_write = false, .blend = blend}, constants)) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  no_vertices_ = gpu::Handle<gpu::delete_vertex_array>(name);
}

void ScreenPass::run(const std::vector<gpu::Attachment>& images) const {
  const gpu::Framebuffer target(images);
  pipeline_.draw(target, [&] {
    glBindVertexArray(no_vertices_.get());
    if (texels_ == Texels::all) {
      glDrawArrays(GL_TRIANGLES, 0, 3);
    } else {
      glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 2);
    }
  });
}

ScreenPass ray_pass(const ViewRays& rays, std::span<const std::uint32_t> fragment,
                    std::span<const gpu::Constant> constants, gpu::Blend blend) {
  std::vector<gpu::Constant> all(constants.begin(), constants.end());
  all.emplace_back(22, rays.are_listed());
  return ScreenPass(fragment, all, blend, rays.are_listed() ? Texels::listed : Texels::all);
}

}  // namespace airlight::frame
