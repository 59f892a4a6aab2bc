#include "frame/screen_pass.h"

#include <epoxy/gl.h>

#include "spirv/frame/screen_vert.h"

namespace airlight::frame {

ScreenPass::ScreenPass(std::span<const std::uint32_t> fragment, std::span<const gpu::Constant> constants,
                       gpu::Blend blend)
    : pipeline_(gpu::Pipeline::graphics({.vertex = k_screen_vert, .fragment = fragment},
                                        {.depth_write = false, .blend = blend}, constants)) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  no_vertices_ = gpu::Handle<gpu::delete_vertex_array>(name);
}

void ScreenPass::run(const std::vector<gpu::Attachment>& images) const {
  const gpu::Framebuffer target(images);
  pipeline_.draw(target, [&] {
    glBindVertexArray(no_vertices_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  });
}

}  // namespace airlight::frame
