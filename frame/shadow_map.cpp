#include "frame/shadow_map.h"

#include <fmt/format.h>

#include "frame/reversed_depth.h"
#include "scene/error.h"

#include "spirv/frame/shadow_map_frag.h"
#include "spirv/frame/shadow_map_vert.h"

namespace airlight::frame {

ShadowMap::ShadowMap(const gpu::Context& context, int size) {
  const int limit = std::min(context.limits().max_texture_size, context.limits().max_viewport);
  if (size > limit) {
    throw scene::Error(
        scene::ExitCode::driver, "--shadow-map",
        fmt::format("{} texels are more than this driver's {} (GL_MAX_TEXTURE_SIZE)", size, limit),
        "ask for a smaller one");
  }
  depth_ = gpu::Texture(gpu::Format::depth32f, {size, size}, 6);
  for (int face = 0; face < 6; ++face)
    faces_.push_back(gpu::Framebuffer({}, gpu::Attachment(depth_, 0, face)));
  program_ =
      gpu::Pipeline::graphics({.vertex = k_shadow_map_vert, .fragment = k_shadow_map_frag}, k_reversed_depth);
}

void ShadowMap::draw(const SceneBuffers& scene, glm::dvec3 light,
                     std::span<const std::uint32_t> left_out) const {
  for (int face = 0; face < 6; ++face) {
    const gpu::Framebuffer& target = faces_[static_cast<std::size_t>(face)];
    target.clear();
    program_.set(0, face);
    // The same axes as in shaders/frame/shadow_cube.glsl.
    const int axis = face / 2;
    const auto unit = [](int i) { return glm::dvec3(i == 0, i == 1, i == 2); };
    const glm::dvec3 forward = unit(axis) * (face % 2 == 0 ? 1.0 : -1.0);
    program_.draw(target, [&] {
      scene.draw({.apex = light,
                  .right = unit((axis + 1) % 3),
                  .up = unit((axis + 2) % 3),
                  .forward = forward,
                  .half_width = 1.0,
                  .half_height = 1.0},
                 left_out);
    });
  }
}

}  // namespace airlight::frame
