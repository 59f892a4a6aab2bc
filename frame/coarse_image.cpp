#include "frame/coarse_image.h"

#include <algorithm>

#include "frame/blocks.h"

#include "spirv/frame/upsample_frag.h"

namespace airlight::frame {

glm::ivec2 coarse_size(glm::ivec2 size, Where where) {
  const int step = where == Where::half ? 2 : where == Where::quarter ? 4 : 1;
  const int height = (size.y + step - 1) / step;
  // Pixels stay square, and the image as wide.
  const std::int64_t width = (std::int64_t{size.x} * height + size.y - 1) / size.y;
  return {std::max(static_cast<int>(width), 1), height};
}

CoarseImage::CoarseImage(Where where)
    : where_(where), camera_block_(sizeof(shaders::CameraBlock)), upsample_(k_upsample_frag) {}

void CoarseImage::begin(const scene::View& view, const GBuffer& gbuffer, const SceneBuffers& scene,
                        float near) {
  view_ = view;
  view_.size = coarse_size(view.size, where_);
  if (surfaces_.size() != view_.size) {
    surfaces_ = gpu::Texture(gpu::Format::rgba32f, view_.size);
    airlight_ = gpu::Texture(gpu::Format::rgba32f, view_.size);
  }
  const shaders::CameraBlock block =
      camera_block(scene::camera_frame(view_.camera, view_.size), view_.size, near);
  camera_block_.write(&block, sizeof block);
  bind_camera();
  gbuffer.find_surfaces(scene, surfaces_);
}

void CoarseImage::bind_camera() const {
  camera_block_.bind_uniform(shaders::k_camera_block);
}

void CoarseImage::upsample(const gpu::Texture& surfaces, const gpu::Texture& airlight) const {
  surfaces.bind_sampler(shaders::k_surface_unit);
  surfaces_.bind_sampler(shaders::k_scratch_unit);
  airlight_.bind_sampler(shaders::k_airlight_unit);
  upsample_.run({airlight});
}

}  // namespace airlight::frame
